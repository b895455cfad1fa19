// SPDX-License-Identifier: GPL-3.0-or-later
// Private to App: the numbers that options take.
#pragma once

#include <string>

#include "base/error.hpp"
#include "cli/app.hpp"

namespace vam::cli {

/// "0 to 1", "more than 0", ...; empty for any number.
[[nodiscard]] std::string describe(const Range& range);

/// The number that the text is. Throws Fault::usage, in the name of the option, for what is none or out of range.
[[nodiscard]] double checked_number(const std::string& flag, const std::string& text, const Range& range);
[[nodiscard]] int checked_integer(const std::string& flag, const std::string& text, const Range& range);

/// What to throw where the text is none of the words allowed.
[[nodiscard]] Error not_one_of(const std::string& flag, const std::string& text, const std::vector<std::string>& words);

}  // namespace vam::cli
