// SPDX-License-Identifier: GPL-3.0-or-later
// JSON out of files and lines that others may have written.
#pragma once

#include <string>
#include <string_view>

#include "base/json_fwd.hpp"

namespace vam {

enum class Keys { any, distinct };

/// The value of a text; discarded (is_discarded()) where the text is no JSON, or nested deeper than 64 levels: what
/// walks a value calls itself once a level, and a file of 100 kB could end it. Keys::distinct: discarded, too, where an
/// object has a key twice, of which one would be believed.
[[nodiscard]] Json parse_json(std::string_view text, Keys keys = Keys::any);

/// What stands at a key, or `otherwise` where there is none or something of another type.
[[nodiscard]] double number_at(const Json& object, const char* key, double otherwise = 0);
[[nodiscard]] std::string text_at(const Json& object, const char* key, const std::string& otherwise = "");

}  // namespace vam
