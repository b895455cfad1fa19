// SPDX-License-Identifier: GPL-3.0-or-later
// Reports, and records and frozen printer files, which bear a seal, too: io/stream/seal.hpp. A text without one is
// taken as it is.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "base/text/format_version.hpp"
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

/// Writes {"schema": "<tool>/<version>", ...figures}; units are in the keys. Nothing when path is empty; "-" is stdout.
/// Throws Error: no_output, io.
void write_report(const std::string& path, FormatKind schema, const Json& figures);

/// The gelation threshold I_p in the record that vam-calibrate resin or working-curve wrote. Throws Error: no_input,
/// data (not such a record, or its isovalue is not above 0).
[[nodiscard]] double gelation_isovalue(const std::string& path);

/// A JSON file of one of these schemas, its seal held to. Throws Error: no_input, data.
[[nodiscard]] Json sealed_record(const std::string& path, std::initializer_list<FormatKind> schemas);

}  // namespace vam::io
