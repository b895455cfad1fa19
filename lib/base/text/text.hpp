// SPDX-License-Identifier: GPL-3.0-or-later
// Small text helpers for messages and option values.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vam {

/// The whole of `text` as a finite or infinite decimal number in the C locale; nothing when any character is left over.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// "a,b,c" to its parts; an empty text has none.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

/// Without the blanks at either end.
[[nodiscard]] std::string trimmed(std::string_view text, std::string_view blanks = " \t\r\n");

/// The only candidate that begins with `word`, else the one with the smallest edit distance to it; empty when none is
/// within a third of its length.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean --voxel?" or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c"
[[nodiscard]] std::string join(const std::vector<std::string>& parts, std::string_view separator);

/// `text` broken at blanks into lines of at most `width` bytes, `indent` blanks before each.
[[nodiscard]] std::string wrap(std::string_view text, int width, int indent);

/// Shortest decimal form with at most `digits` significant digits, for messages: format_number(0.0650) = "0.065".
[[nodiscard]] std::string format_number(double value, int digits = 6);

/// Without an exponent, as limits are told: 1000000000, 0.000001; the shortest form where that has no digit.
[[nodiscard]] std::string plain_number(double value);

/// "1.5 mm"
[[nodiscard]] std::string mm_text(double value_mm);

/// "640 x 480", columns and rows.
[[nodiscard]] std::string size_text(int columns, int rows);

}  // namespace vam
