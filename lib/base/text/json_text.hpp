// SPDX-License-Identifier: GPL-3.0-or-later
// JSON out of files and lines that others may have written.
#pragma once

#include <string>
#include <string_view>

#include "base/text/format_version.hpp"
#include "base/text/json_fwd.hpp"

namespace vam {

/// The value of a text, in a time proportional to its length; discarded (is_discarded()) where the text is no JSON,
/// nested deeper than 64 levels (what walks a value calls itself once a level, and a file of 100 kB could end it), or
/// has an object of more than 1024 keys.
[[nodiscard]] Json parse_json(std::string_view text);

/// The same of what is evidence: throws Fault::data where an object has a key twice, of which only one would be
/// believed, or more than 1024 keys, and where it states a schema of these tools in a version that is not read. `name`
/// begins the message.
[[nodiscard]] Json parse_distinct(std::string_view text, const std::string& name);

/// Whether it is an object of that schema, whatever its version.
[[nodiscard]] bool is_of(const Json& value, FormatKind kind);

/// What stands at a key, or `otherwise` where there is none or something of another type.
[[nodiscard]] double number_at(const Json& object, const char* key, double otherwise = 0);
[[nodiscard]] std::string text_at(const Json& object, const char* key, const std::string& otherwise = "");

}  // namespace vam
