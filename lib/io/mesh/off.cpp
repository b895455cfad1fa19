// SPDX-License-Identifier: GPL-3.0-or-later
// OFF as text, an element a line; behind the coordinates and corners may stand normals and colours, which are not read.
#include <limits>

#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/text.hpp"

namespace vam::io {

namespace {

using Numbers = std::vector<double>;

/// Of the next line that has any, without its comment: none at the end, NaN where the line has something else.
Numbers next_numbers(Lines& lines) {
  Numbers numbers;
  while (numbers.empty() && lines.next()) {
    std::string_view rest = lines.line.substr(0, lines.line.find('#'));
    for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
      const auto number = number_of<double>(word);
      if (!number) return {std::numeric_limits<double>::quiet_NaN()};
      numbers.push_back(*number);
    }
  }
  return numbers;
}

// "3 0 2 1", and what may follow.
bool is_face(const Numbers& line) {
  return !line.empty() && is_whole(line[0], static_cast<double>(line.size() - 1)) &&
         std::all_of(line.begin() + 1, line.begin() + 1 + static_cast<std::ptrdiff_t>(line[0]),
                     [](double index) { return is_whole(index, std::numeric_limits<int>::max()); });
}

}  // namespace

PolygonSoup parse_off(const std::string& bytes) {
  Lines lines{bytes};
  lines.rest.remove_prefix(std::min(bytes.find("OFF") + 3, bytes.size()));  // by which it was recognised
  if (std::string_view text = lines.rest; take_word(text) == "BINARY")
    throw MeshProblem{"is a binary OFF file; save it as text"};
  const Numbers counts = next_numbers(lines);
  constexpr double most = 1e15;
  if (counts.size() < 2 || !is_whole(counts[0], most) || !is_whole(counts[1], most)) {
    throw MeshProblem{"the OFF header has no counts; mend it, or save the mesh again"};
  }
  const auto vertices = static_cast<std::uint64_t>(counts[0]);
  const auto faces = static_cast<std::uint64_t>(counts[1]);
  require_count(vertices, "vertices", bytes);
  require_count(faces, "faces", bytes);
  PolygonSoup soup;
  while (soup.points.size() < vertices) {
    const Numbers line = next_numbers(lines);
    if (line.size() < 3) give_up("OFF", soup);
    soup.points.push_back({line[0], line[1], line[2]});
  }
  Numbers line = next_numbers(lines);
  for (; is_face(line); line = next_numbers(lines)) {
    const auto corners = line.begin() + 1;
    soup.faces.emplace_back(corners, corners + static_cast<std::ptrdiff_t>(line[0]));
  }
  if (soup.faces.size() < faces) give_up("OFF", soup);
  require_all_read(faces, soup.faces.size());
  if (!line.empty()) throw MeshProblem{"trailing data after the last face; save it again"};
  return soup;
}

}  // namespace vam::io
