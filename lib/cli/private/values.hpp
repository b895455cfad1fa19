// Private to App: the numbers that options take.
#pragma once

#include <string>

#include "cli/app.hpp"

namespace vam::cli {

/// "0 to 1", "more than 0", ...; empty for any number.
[[nodiscard]] std::string describe(const Range& range);

/// The number that the text is. Throws Fault::usage, in the name of the option, for what is none or out of range.
[[nodiscard]] double checked_number(const std::string& flag, const std::string& text, const Range& range);
[[nodiscard]] int checked_integer(const std::string& flag, const std::string& text, const Range& range);

}  // namespace vam::cli
