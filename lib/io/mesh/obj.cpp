// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ: of its lines those of vertices and faces are read, of a face the vertices.

#include "base/text/printable.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/text.hpp"

namespace vam::io {

namespace {

// What other lines may begin with, between blanks.
constexpr std::string_view other_statements =
    " vt vn vp bevel lod c_interp d_interp ctech stech usemap maplib usemtl mtllib shadow_obj trace_obj o g s mg p l "
    "cstype deg step bmat con curv curv2 surf parm trim hole scrv sp end call csh "
    "surf_1 q0_1 q1_1 curv2d_1 surf_2 q0_2 q1_2 curv2d_2 bsp bzp cdc cdp res ";

/// A face may use vertices that follow it: the largest index, and the line of it.
struct Largest {
  long long index = 0;
  std::size_t line = 0;
};

std::string uses(long long index, std::size_t vertices) {
  return "a face uses vertex " + std::to_string(index) + ", of " + std::to_string(vertices);
}

/// Of "7", "+7", "-1", "7/1", "7//3", "7/1/3"; below 0 it counts back from here.
int vertex_of(std::string_view corner, std::size_t vertices, const Lines& at, Largest& largest) {
  const std::size_t slash = std::min(corner.find('/'), corner.size());
  const auto index = number_of<long long>(corner.substr(0, slash));
  if (!index || corner.find_first_not_of("+-0123456789/", slash) != corner.npos)
    at.refuse("a face has the corner " + excerpt(corner) + ", which is no index of a vertex");
  if (*index == 0) at.refuse("a face uses vertex 0, but vertices are counted from 1");
  const auto before = static_cast<long long>(vertices);
  if (*index < -before) at.refuse(uses(*index, vertices) + " before it");
  if (*index > largest.index) largest = {*index, at.number};
  return static_cast<int>(*index > 0 ? *index - 1 : before + *index);
}

void take_line(const Lines& at, PolygonSoup& soup, Largest& largest) {
  std::string_view rest = at.line.substr(0, at.line.find('#'));
  const std::string_view statement = take_word(rest);
  if (statement == "v") {
    const auto point = take_point(rest);
    if (!point) at.refuse(excerpt(without_blanks(at.line)) + " is no vertex of three coordinates");
    soup.points.push_back(*point);
  } else if (statement == "f") {
    std::vector<int>& face = soup.faces.emplace_back();
    for (auto word = take_word(rest); !word.empty(); word = take_word(rest))
      face.push_back(vertex_of(word, soup.points.size(), at, largest));
  } else if (other_statements.find(" " + std::string(statement) + " ") == other_statements.npos && !statement.empty()) {
    at.refuse(excerpt(statement) + " begins no line of an OBJ file");
  }
}

// By a backslash at its end, on the next line. A name in a comment may end in one.
bool is_continued(std::string_view line) {
  const std::string_view text = without_blanks(line);
  return text.ends_with('\\') && !text.starts_with('#');
}

}  // namespace

PolygonSoup parse_obj(const std::string& bytes) {
  PolygonSoup soup;
  Largest largest;
  Lines lines{bytes};
  while (lines.next()) {
    Lines whole = lines;
    std::string joined;
    while (is_continued(lines.line)) {
      joined += lines.line.substr(0, lines.line.rfind('\\'));
      joined += ' ';
      if (!lines.next()) break;
      if (!is_continued(lines.line)) whole.line = joined += lines.line;
    }
    take_line(whole, soup, largest);
  }
  if (largest.index > static_cast<long long>(soup.points.size()))
    Lines{{}, {}, largest.line}.refuse(uses(largest.index, soup.points.size()) + " in the file");
  return soup;
}

}  // namespace vam::io
