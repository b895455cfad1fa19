// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of an OBJ file, before CGAL reads them.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/printable.hpp"
#include "io/mesh/private/formats.hpp"

namespace vam::io {

namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view after_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(blanks), text.size()));
}

bool is_comment(std::string_view line) { return after_blanks(line).starts_with('#'); }

bool is_continued(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line.ends_with('\\') && !is_comment(line);
}

// A backslash at the end of a line continues it on the next. A name in a comment may end in one.
std::string joined(const std::string& bytes) {
  std::string text;
  text.reserve(bytes.size());
  std::size_t line_feeds = 0;  // that are left out, and follow the joined line so that all others keep their numbers
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const std::string_view line = std::string_view(bytes).substr(begin, end - begin);
    begin = end + 1;
    if (is_continued(line)) {
      text += line.substr(0, line.rfind('\\'));
      text += ' ';
      ++line_feeds;
      continue;
    }
    text += line;
    text.append(1 + line_feeds, '\n');
    line_feeds = 0;
  }
  return text;
}

bool is_statement(std::string_view text, char keyword) {
  return text.starts_with(keyword) && (text.size() == 1 || blanks.find(text[1]) != blanks.npos);
}

[[noreturn]] void wrong_line(std::size_t number, const std::string& why) {
  throw MeshProblem{"line " + std::to_string(number) + ": " + why + "; mend the line, or save the mesh again"};
}

struct Vertices {
  long long so_far = 0;  // that a face may use by indices below 0
  long long all = 0;
};

// Of "7", "+7", "-1", "7/1", "7//3", "7/1/3"; none of what is no such corner.
std::optional<long long> vertex_of(std::string_view corner) {
  const std::size_t slash = std::min(corner.find('/'), corner.size());
  if (corner.find_first_not_of("+-0123456789/", slash) != corner.npos) return std::nullopt;
  std::string_view digits = corner.substr(0, slash);
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  long long index = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (problem != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return index;
}

void check_corner(std::string_view corner, const Vertices& vertices, std::size_t number) {
  const std::optional<long long> index = vertex_of(corner);
  if (!index) wrong_line(number, "a face has the corner " + excerpt(corner) + ", which is no index of a vertex");
  if (*index == 0) wrong_line(number, "a face uses vertex 0, but vertices are counted from 1");
  if (*index > vertices.all) {
    wrong_line(number, "a face uses vertex " + std::to_string(*index) + ", of " + std::to_string(vertices.all) +
                           " in the file");
  }
  if (*index < -vertices.so_far) {
    wrong_line(number, "a face uses vertex " + std::to_string(*index) + ", of " + std::to_string(vertices.so_far) +
                           " before it");
  }
}

// In the form that CGAL reads in full, as long as before: indices of vertices and blanks.
void settle_face(char* line, std::size_t size, const Vertices& vertices, std::size_t number) {
  const std::string_view text(line, size);
  std::fill(line + std::min(text.find('#'), size), line + size, ' ');
  for (std::size_t i = 0; i < size; ++i) line[i] = blanks.find(line[i]) == blanks.npos ? line[i] : ' ';
  for (std::string_view rest = after_blanks(after_blanks(text).substr(1)); !rest.empty(); rest = after_blanks(rest)) {
    const std::string_view corner = rest.substr(0, std::min(rest.find(' '), rest.size()));
    check_corner(corner, vertices, number);
    rest.remove_prefix(corner.size());
    char* begin = line + (corner.data() - line);
    std::fill(begin + std::min(corner.find('/'), corner.size()), begin + corner.size(), ' ');
  }
}

void check_vertex(std::string_view text, std::size_t number) {
  if (begins_with_numbers(text.substr(1, text.substr(1).find('#')), 3)) return;
  wrong_line(number, excerpt(text.substr(0, text.find_last_not_of(blanks) + 1)) + " is no vertex of three coordinates");
}

// Calls for_line(begin, size, number) for each line.
template <class ForLine>
void for_lines(const std::string& text, const ForLine& for_line) {
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    for_line(begin, end - begin, number);
    begin = end + 1;
  }
}

}  // namespace

bool begins_with_numbers(std::string_view text, int count) {
  for (; count > 0; --count) {
    text = after_blanks(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    double number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc{} || !std::isfinite(number)) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && blanks.find(text.front()) == blanks.npos) return false;
  }
  return true;
}

std::string checked_obj(const std::string& bytes) {
  std::string text = bytes.find('\\') == std::string::npos ? bytes : joined(bytes);
  const auto statement = [&](std::size_t begin, std::size_t size) {
    return after_blanks(std::string_view(text).substr(begin, size));
  };
  Vertices vertices;
  for_lines(text, [&](std::size_t begin, std::size_t size, std::size_t number) {
    if (!is_statement(statement(begin, size), 'v')) return;
    check_vertex(statement(begin, size), number);
    ++vertices.all;
  });
  for_lines(text, [&](std::size_t begin, std::size_t size, std::size_t number) {
    const std::string_view line = statement(begin, size);
    if (is_statement(line, 'v')) ++vertices.so_far;
    if (is_statement(line, 'f')) settle_face(text.data() + begin, size, vertices, number);
  });
  return text;
}

}  // namespace vam::io
