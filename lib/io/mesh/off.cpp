// SPDX-License-Identifier: GPL-3.0-or-later
// OFF as text, an element a line; behind the coordinates and corners may stand normals and colours, which are not read.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "io/mesh/private/formats.hpp"

namespace vam::io {

namespace {

constexpr std::string_view blank_letters = " \t\r";

class NumberLines {
 public:
  explicit NumberLines(std::string_view text) : rest_(text) {}

  /// The numbers of the next line that has any, without its comment; none at the end, or where it has something else.
  const std::vector<double>& next() {
    numbers_.clear();
    for (good_ = true; good_ && numbers_.empty() && !rest_.empty();) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      good_ = take(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
    }
    return numbers_;
  }
  /// Nothing is left, and there was nothing else.
  [[nodiscard]] bool ended() const { return good_ && numbers_.empty() && rest_.empty(); }

 private:
  bool take(std::string_view line) {
    line = line.substr(0, line.find('#'));
    for (;;) {
      line.remove_prefix(std::min(line.find_first_not_of(blank_letters), line.size()));
      if (line.empty()) return true;
      if (line.front() == '+') line.remove_prefix(1);
      double number = 0;
      const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), number);
      if (problem != std::errc{}) {
        numbers_.clear();
        return false;
      }
      numbers_.push_back(number);
      line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    }
  }

  std::string_view rest_;
  std::vector<double> numbers_;
  bool good_ = true;
};

bool is_whole(double number, double most) { return number >= 0 && number <= most && std::floor(number) == number; }

// "3 0 2 1", and what may follow. False where it is no face.
bool take_face(const std::vector<double>& line, std::vector<int>& face) {
  if (line.empty() || !is_whole(line[0], static_cast<double>(line.size() - 1))) return false;
  face.clear();
  for (std::size_t i = 1; i <= static_cast<std::size_t>(line[0]); ++i) {
    if (!is_whole(line[i], std::numeric_limits<int>::max())) return false;
    face.push_back(static_cast<int>(line[i]));
  }
  return true;
}

}  // namespace

PolygonSoup parse_off(const std::string& bytes) {
  std::string_view text(bytes);
  text.remove_prefix(std::min(text.find("OFF") + 3, text.size()));  // its magic word, by which it was recognised
  const std::size_t word = text.find_first_not_of(blank_letters);
  if (word != std::string_view::npos && text.substr(word).starts_with("BINARY")) {
    throw MeshProblem{"is a binary OFF file; save it as text"};
  }
  NumberLines lines(text);
  const std::vector<double> counts = lines.next();
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
    const std::vector<double>& line = lines.next();
    if (line.size() < 3) give_up("OFF", soup);
    soup.points.push_back({line[0], line[1], line[2]});
  }
  for (std::vector<int> face; soup.faces.size() < faces; soup.faces.push_back(face)) {
    if (!take_face(lines.next(), face)) give_up("OFF", soup);
  }
  std::uint64_t found = faces;
  for (std::vector<int> face; take_face(lines.next(), face);) ++found;
  require_all_read(faces, found);
  if (!lines.ended()) throw MeshProblem{"trailing data after the last face; save it again"};
  return soup;
}

}  // namespace vam::io
