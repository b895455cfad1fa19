// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of an OBJ file, before CGAL reads them.
#include <algorithm>
#include <charconv>
#include <cmath>
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

// An index of a face that is 0: "0", "0/1", "00".
bool has_index_0(std::string_view values) {
  while (!(values = after_blanks(values)).empty()) {
    const std::string_view word = values.substr(0, std::min(values.find_first_of(blanks), values.size()));
    values.remove_prefix(word.size());
    const std::string_view index = word.substr(0, word.find('/'));
    if (!index.empty() && index.find_first_not_of('0') == index.npos) return true;
  }
  return false;
}

void check_line(std::string_view line, std::size_t number) {
  const std::string_view text = after_blanks(line);
  if (text.empty() || (text.size() > 1 && blanks.find(text[1]) == blanks.npos)) return;
  const std::string_view values = text.substr(1, text.substr(1).find('#'));
  if (text.front() == 'v' && !begins_with_numbers(values, 3)) {
    throw MeshProblem{"line " + std::to_string(number) + ": " +
                      excerpt(text.substr(0, text.find_last_not_of(blanks) + 1)) +
                      " is no vertex of three coordinates; mend the line, or save the mesh again"};
  }
  if (text.front() == 'f' && values.find('.') != values.npos) {
    throw MeshProblem{"line " + std::to_string(number) + ": a face has an index that is no whole number"};
  }
  if (text.front() == 'f' && has_index_0(values)) {
    throw MeshProblem{"line " + std::to_string(number) +
                      ": a face uses vertex 0, but vertices are counted from 1; mend the line, or save the mesh again"};
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
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    check_line(std::string_view(text).substr(begin, end - begin), number);
    begin = end + 1;
  }
  return text;
}

}  // namespace vam::io
