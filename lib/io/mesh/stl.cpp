// SPDX-License-Identifier: GPL-3.0-or-later
// STL, binary and as text.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string_view>

#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "base/vector3.hpp"
#include "io/mesh/file.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

static_assert(std::endian::native == std::endian::little, "STL and PLY are written as the machine has them");

namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t facet_bytes = 50;  // normal, three corners, 16 bits of attributes

std::uint64_t triangles_promised(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

// What fills a block of a disk, or a line end of a program that saw text. Nothing else of a mesh looks so.
bool is_padding(std::string_view bytes) {
  constexpr std::size_t blank_bytes = std::size_t{1} << 16;
  return bytes.size() <= blank_bytes && bytes.find_first_not_of(std::string_view("\0 \t\r\n", 5)) == bytes.npos;
}

std::array<float, 3> normal_of(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto [x, y, z] = cross(b - a, c - a);
  const double length = std::hypot(x, y, z);
  if (!(length > 0)) return {0, 0, 0};
  return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

/// What leads from one level of a text to another.
struct Step {
  std::string_view word;
  int from, to;
};
constexpr int in_facet = 2;
constexpr Step steps[] = {{"solid", 0, 1}, {"facet", 1, in_facet}, {"endfacet", in_facet, 1}, {"endsolid", 1, 0}};

}  // namespace

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::uint64_t binary_stl_bytes(const std::string& bytes) {
  return bytes.size() < header_bytes ? 0 : header_bytes + facet_bytes * triangles_promised(bytes);
}

bool has_binary_stl_size(const std::string& bytes) {
  return bytes.size() >= header_bytes && bytes.size() == binary_stl_bytes(bytes);
}

namespace {

PolygonSoup parse_binary_stl(const std::string& bytes) {
  if (bytes.size() < header_bytes) {
    throw MeshProblem{"not a whole STL file: " + std::to_string(bytes.size()) + " bytes, the header alone has 84"};
  }
  const std::uint64_t count = triangles_promised(bytes);
  if (bytes.size() < binary_stl_bytes(bytes)) {
    throw MeshProblem{"neither a mesh of another format nor a whole binary STL, whose header would state " +
                      std::to_string(count) + " triangles (" + std::to_string(binary_stl_bytes(bytes)) +
                      " bytes): it has " + std::to_string(bytes.size()) +
                      " bytes, is truncated or damaged; export it again"};
  }
  if (const std::string_view rest = std::string_view(bytes).substr(binary_stl_bytes(bytes));
      count > 0 && !is_padding(rest)) {
    throw MeshProblem{std::to_string(rest.size()) + " bytes follow the " + std::to_string(count) +
                      " triangles that the header states; its count is damaged, or the file holds more than a mesh"};
  }
  PolygonSoup soup;
  soup.of_facets = true;
  soup.points.reserve(3 * count);
  soup.faces.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    float corner[9];
    std::memcpy(corner, bytes.data() + header_bytes + facet_bytes * t + 12, sizeof corner);
    const int first = count_of(soup.points);
    for (int c = 0; c < 9; c += 3) soup.points.push_back({corner[c], corner[c + 1], corner[c + 2]});
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

PolygonSoup parse_ascii_stl(const std::string& bytes) {
  std::string text = lower_case(bytes);  // some programs write it in capitals; names do not matter
  if (std::find(text.begin(), text.end(), '\n') == text.end()) std::replace(text.begin(), text.end(), '\r', '\n');
  PolygonSoup soup;
  soup.of_facets = true;
  int level = 0;
  bool ended = false;  // by the last word
  for (Lines lines{text}; lines.next();) {
    std::string_view rest = lines.line;
    for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
      const auto* const step = std::find_if(steps, std::end(steps), [&](const Step& s) { return s.word == word; });
      ended = word == "endsolid";
      if (word == "vertex" && level == in_facet) {
        const std::string_view row = lines.line.substr(static_cast<std::size_t>(word.data() - lines.line.data()));
        const auto point = take_point(rest);
        if (!point) lines.refuse(excerpt(without_blanks(row)) + " is no vertex of three finite coordinates");
        soup.points.push_back(*point);
      }
      if (step == std::end(steps)) continue;
      if (step->from != level) give_up("STL", soup);
      level = step->to;
      const int first = 3 * count_of(soup.faces);
      if (word == "endfacet") soup.faces.push_back({first, first + 1, first + 2});
      if (soup.points.size() != 3 * soup.faces.size()) give_up("STL", soup);
      if (word.ends_with("solid")) break;  // a name follows
    }
  }
  if (!ended) throw MeshProblem{"the STL text does not end in 'endsolid'; it is truncated"};
  return soup;
}

}  // namespace

PolygonSoup parse_stl(const std::string& bytes) {
  const bool binary = has_binary_stl_size(bytes) || bytes.find('\0') != std::string::npos;
  return binary ? parse_binary_stl(bytes) : parse_ascii_stl(bytes);
}

void write_stl(const std::string& path, const model::TriangleSoup& mesh) {
  OutputFile file(path);
  std::string header(80, ' ');
  header.replace(0, 10, "binary STL");
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  file.write(header);
  file.write(&count, sizeof count);
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& points = mesh.points;
    float record[12];
    const auto normal = normal_of(points[a], points[b], points[c]);
    std::memcpy(record, normal.data(), sizeof normal);
    float* next = record + 3;
    for (const int corner : {a, b, c}) {
      for (const double x : points[corner]) *next++ = static_cast<float>(x);
    }
    const std::uint16_t attributes = 0;
    file.write(record, sizeof record);
    file.write(&attributes, sizeof attributes);
  }
  file.commit();
}

}  // namespace vam::io
