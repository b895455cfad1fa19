// JSON out of files and lines that others may have written.
#pragma once

#include <string_view>

#include "base/json_fwd.hpp"

namespace vam {

/// The value of a text; discarded (is_discarded()) where the text is no JSON, or nested deeper than 64 levels: what
/// walks a value calls itself once a level, and a file of 100 kB could end it.
[[nodiscard]] Json parse_json(std::string_view text);

}  // namespace vam
