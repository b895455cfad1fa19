// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/private/values.hpp"

#include <limits>

#include "base/text/text.hpp"

namespace vam::cli {

std::string describe(const Range& range) {
  const bool has_low = range.low > any.low;
  const bool has_high = range.high < any.high;
  const std::string besides = range.not_zero ? ", but not 0" : "";
  const std::string low = plain_number(range.low);
  const std::string high = plain_number(range.high);
  if (range.low == range.high) return low;
  if (has_low && has_high) return (range.open_low ? "more than " + low + ", at most " : low + " to ") + high + besides;
  if (has_low) return (range.open_low ? "more than " : "at least ") + low;
  if (has_high) return "at most " + high;
  return range.not_zero ? "any number but 0" : "";
}

double checked_number(const std::string& flag, const std::string& text, const Range& range) {
  const auto value = parse_number(text);
  if (!value) throw Error{Fault::usage, flag + ": '" + text + "' is not a number"};
  const bool low_ok = range.open_low ? *value > range.low : *value >= range.low;
  if (!low_ok || *value > range.high || (range.not_zero && *value == 0)) {
    throw Error{Fault::usage, flag + ": " + text + " is out of range; give " + describe(range)};
  }
  return *value;
}

int checked_integer(const std::string& flag, const std::string& text, const Range& range) {
  const double value = checked_number(flag, text, range);
  const int whole = value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max()
                        ? static_cast<int>(value)
                        : 0;
  if (static_cast<double>(whole) != value) throw Error{Fault::usage, flag + ": '" + text + "' is not a whole number"};
  return whole;
}

Error not_one_of(const std::string& flag, const std::string& text, const std::vector<std::string>& words) {
  return {Fault::usage, flag + ": '" + text + "' is not one of " + join(words, ", ") + did_you_mean(text, words)};
}

}  // namespace vam::cli
