// SPDX-License-Identifier: GPL-3.0-or-later
// The text formats and PLY through CGAL. CGAL's readers trust the counts in a header and accept some cut files, so both
// are examined first.
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "base/printable.hpp"
#include "io/mesh/private/formats.hpp"

namespace vam::io {

namespace {

using CgalPoint = CGAL::Simple_cartesian<double>::Point_3;

struct CgalSoup {
  std::vector<CgalPoint> points;
  std::vector<std::vector<int>> faces;
};

PolygonSoup converted(CgalSoup&& soup) {
  PolygonSoup result;
  result.points.reserve(soup.points.size());
  for (const auto& p : soup.points) result.points.push_back({p.x(), p.y(), p.z()});
  result.faces = std::move(soup.faces);
  return result;
}

// CGAL takes coordinates of other types, and lists, for floats.
void check_ply_property(const std::string& element, const std::string& type, const std::string& name) {
  if (element.empty())
    throw MeshProblem{"the PLY header has a property of no element; mend it, or save the mesh again"};
  const bool coordinate = (element == "vertex" || element == "vertices") && (name == "x" || name == "y" || name == "z");
  if (!coordinate || type == "float" || type == "double" || type == "float32" || type == "float64") return;
  throw MeshProblem{"the PLY coordinate " + name + " is of type " + type +
                    "; float and double are read, save it as one of them"};
}

// True where its numbers are text.
bool check_ply_header(const std::string& bytes) {
  std::string element;
  bool text = false;
  std::size_t begin = 0;
  for (int line = 0; begin < bytes.size(); ++line) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
    std::istringstream words(bytes.substr(begin, end - begin));
    begin = end + 1;
    std::string keyword;
    std::string first;
    std::string second;
    words >> keyword >> first >> second;
    if (line == 1) text = first == "ascii";
    if (line < 2) continue;  // magic word and format
    if (keyword == "end_header") return text;
    if (keyword == "property") {
      std::string name = second;
      if (first == "list") words >> name >> name;  // behind the types of count and entries
      check_ply_property(element, first, name);
    }
    if (keyword != "element") continue;
    element = first;
    if (second.starts_with('-'))
      throw MeshProblem{"the PLY header states " + second + " " + element +
                        " elements; mend it, or save the mesh again"};
    std::uint64_t count = 0;
    if (std::istringstream(second) >> count) require_count(count, element.c_str(), bytes);
  }
  throw MeshProblem{"the PLY header has no end_header; the file is truncated"};
}

// What follows the last element: of a text lines, each of which is a face; of others nothing may but the end of a line.
void require_ply_end(std::istream& stream, bool text, std::size_t faces, std::size_t size) {
  stream.exceptions(std::ios::goodbit);
  const std::string rest(std::istreambuf_iterator<char>(stream), {});
  constexpr std::size_t face_bytes = 13;  // of bytes: the smallest face
  if (!text) {
    require_all_read(faces, faces + rest.size() / face_bytes);
    if (rest.size() <= 2 && rest.find_first_not_of("\r\n") == rest.npos) return;  // the end of a line
    throw MeshProblem{"trailing data after the last face, from byte " + std::to_string(size - rest.size()) +
                      " on; save it again"};
  }
  std::istringstream lines(rest);
  std::uint64_t left = 0;
  for (std::string line; std::getline(lines, line);) left += line.find_first_not_of(" \t\r") == line.npos ? 0 : 1;
  require_all_read(faces, faces + left);
}

}  // namespace

namespace {

// CGAL takes a line that is no vertex for the end of the file. text: in small letters.
void check_stl_vertices(std::string_view text) {
  constexpr std::string_view word = "vertex";
  std::size_t line = 1;
  std::size_t counted = 0;  // the line feeds up to here
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + word.size())) {
    const std::size_t begin = text.find_last_of('\n', at) + 1;  // 0 in the first line
    const std::string_view before = text.substr(begin, at - begin);
    if (before.find_first_not_of(" \t") != before.npos) continue;  // in a name
    line += static_cast<std::size_t>(std::count(text.data() + counted, text.data() + at, '\n'));
    counted = at;
    const std::string_view row = text.substr(at, std::min(text.find_first_of("\r\n", at), text.size()) - at);
    if (begins_with_numbers(row.substr(word.size()), 3)) continue;
    throw MeshProblem{"line " + std::to_string(line) + ": " + excerpt(row) +
                      " is no vertex of three finite coordinates; mend the line, or save the mesh again"};
  }
}

}  // namespace

PolygonSoup parse_ascii_stl(const std::string& bytes) {
  std::string text = lower_case(bytes);  // CGAL knows no capitals; names do not matter
  if (text.find('\n') == text.npos) std::replace(text.begin(), text.end(), '\r', '\n');
  const std::size_t last_word = text.find_last_not_of(" \t\r\n");
  const std::size_t last_line = text.find_last_of('\n', last_word);
  const std::string tail = last_line == std::string::npos ? "" : text.substr(last_line + 1);
  if (tail.find("endsolid") == std::string::npos) {
    throw MeshProblem{"the STL text does not end in 'endsolid'; it is truncated"};
  }
  check_stl_vertices(text);
  std::istringstream stream(text);
  CgalSoup soup;
  if (!CGAL::IO::read_STL(stream, soup.points, soup.faces)) give_up("STL", converted(std::move(soup)));
  return converted(std::move(soup));
}

PolygonSoup parse_obj(const std::string& bytes) {
  std::istringstream stream(checked_obj(bytes));
  CgalSoup soup;
  // False also for a file without faces, which the caller names for what it is.
  if (!CGAL::IO::read_OBJ(stream, soup.points, soup.faces) && !soup.faces.empty())
    give_up("OBJ", converted(std::move(soup)));
  return converted(std::move(soup));
}

PolygonSoup parse_ply(const std::string& bytes) {
  const bool text = check_ply_header(bytes);
  std::istringstream stream(text ? bytes + "\n" : bytes);   // a number that ends with the file is whole
  stream.exceptions(std::ios::failbit | std::ios::badbit);  // CGAL reads all of a list, even behind the end
  CgalSoup soup;
  std::vector<CGAL::IO::Color> of_faces;
  std::vector<CGAL::IO::Color> of_points;
  try {
    if (!CGAL::IO::read_PLY(stream, soup.points, soup.faces, of_faces, of_points))
      give_up("PLY", converted(std::move(soup)));
  } catch (const std::ios_base::failure&) {
    give_up("PLY", converted(std::move(soup)));
  } catch (const std::length_error&) {  // a list of fewer than 0 values
    give_up("PLY", converted(std::move(soup)));
  }
  require_ply_end(stream, text, soup.faces.size(), bytes.size());
  PolygonSoup result = converted(std::move(soup));
  result.uncertainty = ply_numbers(bytes, "scalar_uncertainty", result.points.size());
  if (of_points.size() != result.points.size()) return result;
  for (const CGAL::IO::Color& colour : of_points)
    result.colours.push_back({colour.red(), colour.green(), colour.blue()});
  return result;
}

}  // namespace vam::io
