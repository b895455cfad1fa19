// Names come from outside and may hold any byte; a terminal obeys some of them.
#pragma once

#include <string>
#include <string_view>

namespace vam {

/// Control characters (ASCII, and C1 in UTF-8) become \n, \t or \x1b; the rest stays as it is.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace vam
