// SPDX-License-Identifier: GPL-3.0-or-later
// Logs whose lines follow from each other: none can be changed, lost or exchanged unseen [formats: EVENT LOGS].
#pragma once

#include <string>
#include <string_view>

namespace vam {

/// A JSON object with a last key "chain": 16 hexadecimal digits, XXH3 (64 bits) of the chain of the line before it,
/// empty for the first, and of the object without that key. Sets `chain`, that of the line before, to its own.
[[nodiscard]] std::string chained(std::string_view object, std::string& chain);

/// The chain of a line, without its end; empty where it has none.
[[nodiscard]] std::string chain_of(std::string_view line);

/// Whether a line with a chain follows that with the chain `before`.
[[nodiscard]] bool follows(std::string_view line, std::string_view before);

}  // namespace vam
