// SPDX-License-Identifier: GPL-3.0-or-later
// PLY as text or bytes of either order: of vertices places, colours and uncertainties, of faces their vertices.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/text/printable.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/text.hpp"

namespace vam::io {

namespace {

template <class Number>
double number_in(const char* bytes) {
  Number number{};
  std::memcpy(&number, bytes, sizeof number);
  return static_cast<double>(number);
}

struct Type {
  std::size_t size = 0;
  double (*read)(const char* bytes) = nullptr;
  bool real = false;
  bool byte = false;  // 0 to 255
};

template <class Number>
constexpr Type type_of{sizeof(Number), number_in<Number>, std::is_floating_point_v<Number>,
                       std::is_same_v<Number, std::uint8_t>};

constexpr std::string_view little_endian = "binary_little_endian";
constexpr std::string_view big_endian = "binary_big_endian";

struct Property {
  std::string name;
  Type type;                  // of a list: of its values
  std::optional<Type> count;  // of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  [[nodiscard]] bool is_vertex() const { return name == "vertex" || name == "vertices"; }
  [[nodiscard]] bool is_face() const { return name == "face" || name == "faces"; }
};

struct Header {
  std::string_view form;
  std::vector<Element> elements;
  std::string_view values;  // that follow
};

Type type_named(std::string_view wanted) {
  constexpr struct {
    std::string_view name, other;
    Type type;
  } all[] = {{"char", "int8", type_of<std::int8_t>},    {"uchar", "uint8", type_of<std::uint8_t>},
             {"short", "int16", type_of<std::int16_t>}, {"ushort", "uint16", type_of<std::uint16_t>},
             {"int", "int32", type_of<std::int32_t>},   {"uint", "uint32", type_of<std::uint32_t>},
             {"float", "float32", type_of<float>},      {"double", "float64", type_of<double>}};
  for (const auto& [name, other, type] : all)
    if (wanted == name || wanted == other) return type;
  throw MeshProblem{"the PLY header has a property of type " + excerpt(wanted) + "; mend it, or save the mesh again"};
}

void add_property(std::string_view words, std::vector<Element>& elements) {
  if (elements.empty())
    throw MeshProblem{"the PLY header has a property of no element; mend it, or save the mesh again"};
  Property property;
  const std::string_view type = take_word(words);
  if (type == "list") property.count = type_named(take_word(words));
  property.type = type_named(type == "list" ? take_word(words) : type);
  property.name = take_word(words);
  const bool coordinate = property.name == "x" || property.name == "y" || property.name == "z";
  if (elements.back().is_vertex() && coordinate && (property.count || !property.type.real)) {
    throw MeshProblem{"the PLY coordinate " + property.name + " is of type " + std::string(type) +
                      "; float and double are read, save it as one of them"};
  }
  elements.back().properties.push_back(std::move(property));
}

Element element_of(std::string_view words, const std::string& bytes) {
  Element element;
  element.name = take_word(words);
  const std::string count(take_word(words));
  const auto number = number_of<double>(count);
  if (!number || !is_whole(*number, 1e18)) {
    throw MeshProblem{"the PLY header states " + printable(count) + " " + element.name +
                      " elements; mend it, or save the mesh again"};
  }
  element.count = static_cast<std::uint64_t>(*number);
  require_count(element.count, element.name.c_str(), bytes);
  return element;
}

Header header_of(const std::string& bytes) {
  Header header;
  Lines lines{bytes};
  while (lines.next()) {
    std::string_view words = lines.line;
    const std::string_view keyword = take_word(words);
    if (keyword == "format") header.form = take_word(words);
    if (keyword == "element") header.elements.push_back(element_of(words, bytes));
    if (keyword == "property") add_property(words, header.elements);
    if (keyword != "end_header") continue;
    header.values = lines.rest;
    if (header.form == "ascii" || header.form == little_endian || header.form == big_endian) return header;
    throw MeshProblem{"the PLY header states the format " + excerpt(header.form) + "; save the mesh again"};
  }
  throw MeshProblem{"the PLY header has no end_header; the file is truncated"};
}

/// The numbers behind the header, property by property.
struct Values {
  std::string_view form;
  std::string_view rest;
  std::vector<double> list = {};  // those of the last property: one, or those of a list

  /// False at the end, where text is no number, and where a list is longer than what is left.
  bool next(const Property& property) {
    const auto count = property.count ? number(*property.count) : 1;
    const std::size_t least_bytes = form == "ascii" ? 1 : property.type.size;
    if (!count || !is_whole(*count, static_cast<double>(rest.size() / least_bytes))) return false;
    list.clear();
    for (auto left = static_cast<std::size_t>(*count); left > 0; --left) {
      const auto value = number(property.type);
      if (!value) return false;
      list.push_back(*value);
    }
    return true;
  }

 private:
  std::optional<double> number(const Type& type) {
    if (form == "ascii") return number_of<double>(take_word(rest));
    if (rest.size() < type.size) return std::nullopt;
    std::array<char, 8> bytes{};
    std::copy_n(rest.data(), type.size, bytes.data());
    if (form == big_endian) std::reverse(bytes.data(), bytes.data() + type.size);
    rest.remove_prefix(type.size);
    return type.read(bytes.data());
  }
};

/// Where a single value of one of these names stands among the properties; -1: nowhere.
int place_of(const Element& element, std::string_view name, std::string_view other) {
  const auto& all = element.properties;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Property& property) {
    return !property.count && (property.name == name || property.name == other);
  });
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

void read_vertices(const Element& element, Values& values, PolygonSoup& soup) {
  const std::array xyz{place_of(element, "x", "x"), place_of(element, "y", "y"), place_of(element, "z", "z")};
  const std::array rgb{place_of(element, "red", "r"), place_of(element, "green", "g"), place_of(element, "blue", "b")};
  const int uncertainty = place_of(element, "scalar_uncertainty", "scalar_uncertainty");
  if (*std::min_element(xyz.begin(), xyz.end()) < 0)
    throw MeshProblem{"the PLY vertices have no x, y and z; save the mesh again"};
  const bool coloured =
      std::all_of(rgb.begin(), rgb.end(), [&](int place) { return place >= 0 && element.properties[place].type.byte; });
  std::vector<double> row(element.properties.size());
  for (std::uint64_t v = 0; v < element.count; ++v) {
    for (std::size_t p = 0; p < row.size(); ++p) {
      if (!values.next(element.properties[p])) give_up("PLY", soup);
      row[p] = values.list.empty() ? 0 : values.list[0];
    }
    const auto byte = [&](int place) { return static_cast<std::uint8_t>(std::clamp(row[place], 0.0, 255.0)); };
    soup.points.push_back({row[xyz[0]], row[xyz[1]], row[xyz[2]]});
    if (coloured) soup.colours.push_back({byte(rgb[0]), byte(rgb[1]), byte(rgb[2])});
    if (uncertainty >= 0) soup.uncertainty.push_back(static_cast<float>(row[uncertainty]));
  }
}

void read_others(const Element& element, Values& values, PolygonSoup& soup) {
  for (std::uint64_t e = 0; e < element.count; ++e) {
    for (const Property& property : element.properties) {
      if (!values.next(property)) give_up("PLY", soup);
      if (!element.is_face() || !property.count) continue;
      if (property.name != "vertex_index" && property.name != "vertex_indices") continue;
      std::vector<int>& face = soup.faces.emplace_back();
      for (const double index : values.list) {
        if (!is_whole(index, std::numeric_limits<int>::max())) give_up("PLY", soup);
        face.push_back(static_cast<int>(index));
      }
    }
  }
}

// What follows the last element: of a text lines, each of which is a face; of others nothing may but the end of a line.
void require_end(std::string_view rest, std::string_view form, std::size_t faces, std::size_t size) {
  constexpr std::size_t face_bytes = 13;  // of bytes: the smallest face
  std::uint64_t left = 0;
  if (form == "ascii") {
    for (Lines lines{rest}; lines.next();) left += without_blanks(lines.line).empty() ? 0 : 1;
  } else {
    left = rest.size() / face_bytes;
  }
  require_all_read(faces, faces + left);
  if (form == "ascii" || (rest.size() <= 2 && rest.find_first_not_of("\r\n") == rest.npos)) return;
  throw MeshProblem{"trailing data after the last face, from byte " + std::to_string(size - rest.size()) +
                    " on; save it again"};
}

}  // namespace

PolygonSoup parse_ply(const std::string& bytes) {
  const Header header = header_of(bytes);
  Values values{header.form, header.values};
  PolygonSoup soup;
  for (const Element& element : header.elements) {
    const auto read = element.is_vertex() ? read_vertices : read_others;
    read(element, values, soup);
  }
  require_end(values.rest, header.form, soup.faces.size(), bytes.size());
  return soup;
}

}  // namespace vam::io
