// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/text/format_version.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/array/private/array.hpp"

namespace vam::io::arrays {

namespace {

constexpr std::size_t required = 5;
/// Fields, and the value of those that have but one; the first are required.
constexpr std::pair<const char*, const char*> known[] = {
    {"type", ""},      {"sizes", ""}, {"dimension", "3"},           {"encoding", "raw"}, {"endian", "little"},
    {"content", ""},   {"kinds", ""}, {"space", "3D-right-handed"}, {"space units", ""}, {"space directions", ""},
    {"labels", ""},    {"units", ""}, {"space origin", ""},         {"axis mins", ""},   {"spacings", ""},
    {"centerings", ""}};

/// The edge of cubes along x, y and z: "(E,0,0) (0,E,0) (0,0,E)" or "E E E"; 0 for anything else.
double edge_of(const std::string& text) {
  const std::size_t at = text.starts_with('(') ? 1 : 0;
  const std::string e = text.substr(at, text.find_first_of(", ", at) - at);
  const bool cubes = text == "(" + e + ",0,0) (0," + e + ",0) (0,0," + e + ")" || text == e + " " + e + " " + e;
  return cubes ? parse_number(e).value_or(0) : 0;
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error(what + "; NRRD is read as vam-view --export writes it: save other volumes as .npy");
}

}  // namespace

Head take_nrrd_head(Bytes& bytes, double& voxel_mm) {
  if (!bytes.line().starts_with(nrrd_magic)) throw std::runtime_error("is no NRRD volume");
  std::map<std::string, std::string> fields;
  for (std::string line = bytes.line(); !line.empty(); line = bytes.line()) {
    if (line.starts_with(version_name + std::string(":="))) {
      const std::string why = FormatKind("NRRD").objection(line.substr(line.find('=') + 1));
      if (!why.empty()) throw std::runtime_error(why);
    }
    if (line.starts_with('#') || line.find(":=") != std::string::npos) continue;
    const std::string name = line.substr(0, line.find(": "));
    const std::string value = line.substr(std::min(name.size() + 2, line.size()));
    if (std::none_of(std::begin(known), std::end(known), [&](const auto& field) {
          return name == field.first && (*field.second == '\0' || value == field.second);
        }))
      refuse("its header has " + excerpt(line));
    if (!fields.try_emplace(name, value).second) refuse("its header states " + excerpt(name) + " twice");
  }
  const bool bits = fields["type"] == "uint8";
  for (const auto& [name, only] : std::span(known).first<required>())
    if (fields[name].empty() && !(bits && name == std::string("endian")))
      refuse(std::string("its header has no '") + name + "'");
  if (!bits && fields["type"] != "float") refuse("has values of type " + excerpt(fields["type"]));
  std::vector<std::uint64_t> shape;
  std::istringstream sizes(fields["sizes"]);  // the fastest first
  for (std::uint64_t size = 0; sizes >> size;) shape.insert(shape.begin(), size);
  if (!sizes.eof() || shape.size() != 3) refuse("its header has sizes " + excerpt(fields["sizes"]));
  const std::string edges = fields["space directions"] + fields["spacings"];
  const bool are_lengths = !edges.empty() && fields["units"].empty();  // the axes of stacks have units
  voxel_mm = are_lengths ? edge_of(edges) : 0;
  if (are_lengths && !(voxel_mm > 0)) refuse("has voxels " + excerpt(edges) + ", no cubes along x, y and z");
  Head head;
  if (bits) head.kind = 'u', head.bytes = 1;
  set_shape(shape, head);
  return head;
}

}  // namespace vam::io::arrays
