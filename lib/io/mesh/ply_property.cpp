// SPDX-License-Identifier: GPL-3.0-or-later
// A number of every vertex in a binary PLY file: CGAL reads places and colours only.
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>

#include "io/mesh/private/formats.hpp"

namespace vam::io {

namespace {

const std::map<std::string, std::size_t>& sizes() {
  static const std::map<std::string, std::size_t> all{{"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},
                                                      {"short", 2}, {"ushort", 2},  {"int16", 2},  {"uint16", 2},
                                                      {"int", 4},   {"uint", 4},    {"int32", 4},  {"uint32", 4},
                                                      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  return all;
}

// Records of the vertices, which come first, and the place of a float in them.
struct VertexRecords {
  std::size_t size = 0;
  std::size_t place = 0;
  bool found = false;
};

VertexRecords records_of(const std::string& header, const std::string& name) {
  VertexRecords records;
  std::istringstream lines(header);
  int elements = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string keyword;
    std::string type;
    std::string called;
    words >> keyword >> type >> called;
    if (keyword == "format" && type != "binary_little_endian") return {};
    if (keyword == "element" && ++elements == 1 && type != "vertex") return {};
    if (keyword != "property" || elements != 1) continue;
    const auto size = sizes().find(type);
    if (size == sizes().end()) return {};
    if (called == name && (type == "float" || type == "float32")) {
      records.found = true;
      records.place = records.size;
    }
    records.size += size->second;
  }
  return records;
}

}  // namespace

std::vector<float> ply_numbers(const std::string& bytes, const std::string& name, std::size_t vertices) {
  const std::string end = "end_header\n";
  const std::size_t begin = bytes.find(end);
  if (begin == std::string::npos) return {};
  const VertexRecords records = records_of(bytes.substr(0, begin), name);
  const std::size_t data = begin + end.size();
  if (!records.found || vertices > (bytes.size() - data) / records.size) return {};
  std::vector<float> numbers(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    std::memcpy(&numbers[i], bytes.data() + data + i * records.size + records.place, sizeof numbers[i]);
  }
  return numbers;
}

}  // namespace vam::io
