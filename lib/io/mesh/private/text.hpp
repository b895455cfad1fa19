// SPDX-License-Identifier: GPL-3.0-or-later
// Lines, words and numbers of a mesh that is text.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "io/mesh/private/formats.hpp"

namespace vam::io {

/// The lines of a text, without their ends, counted from 1.
struct Lines {
  std::string_view rest;  // of the text
  std::string_view line = {};
  std::size_t number = 0;
  /// Goes on to the first or the next; false where there is none.
  bool next() {
    if (rest.empty()) return false;
    line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    ++number;
    return true;
  }
  /// Throws MeshProblem: what is wrong with the line.
  [[noreturn]] void refuse(const std::string& why) const {
    throw MeshProblem{"line " + std::to_string(number) + ": " + why + "; mend the line, or save the mesh again"};
  }
};

inline constexpr std::string_view blanks = " \t\r\n\v\f";

/// Without the blanks around it.
[[nodiscard]] inline std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Takes the next word between blanks off the text; empty where there is none.
inline std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

/// A word that is a finite number, "+1e-3", and nothing else.
template <class Number>
[[nodiscard]] std::optional<Number> number_of(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  Number number = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (problem != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return std::isfinite(static_cast<double>(number)) ? std::optional(number) : std::nullopt;
}

[[nodiscard]] inline bool is_whole(double number, double most) {
  return number >= 0 && number <= most && std::floor(number) == number;
}

/// Takes three finite numbers off the text; nothing where it does not begin with them.
inline std::optional<std::array<double, 3>> take_point(std::string_view& text) {
  std::array<double, 3> point{};
  for (double& coordinate : point) {
    const auto number = number_of<double>(take_word(text));
    if (!number) return std::nullopt;
    coordinate = *number;
  }
  return point;
}

}  // namespace vam::io
