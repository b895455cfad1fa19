// SPDX-License-Identifier: GPL-3.0-or-later
// Records and frozen printer files bear a seal, too: io/stream/seal.hpp. A text without one is taken as it is.
#pragma once

#include <cstdint>
#include <string>

#include "base/text/json_fwd.hpp"

namespace vam::io {

inline constexpr std::uint64_t most_record_bytes = std::uint64_t{1} << 20;

/// Adds the key `seal`: of all the others, whatever their order and the layout of the file.
void seal_json(Json& object);
/// Throws Fault::data where an object has a seal that is not its own. `name` begins the message. True when it has one.
bool require_seal(const Json& object, const std::string& name);

/// The text with a last line "# sealed xxh3:...", of all bytes before it.
[[nodiscard]] std::string sealed_text(std::string text);
/// Throws Fault::data where the text ends in such a line and differs. True when it ends in one.
bool require_text_seal(const std::string& text, const std::string& name);

}  // namespace vam::io
