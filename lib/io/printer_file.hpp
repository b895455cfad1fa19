// The printer file: the instrument's settings as TOML, read strictly.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/printer.hpp"

namespace vam::io {

/// The settings in force. Of these the first that exists is read: `file` (when not empty), $VAM_PRINTER,
/// ./printer.toml, else the embedded default, the printer of [RAY21]. Then each of `sets`, "vial.radius_mm=12",
/// overrides one setting; a text needs no quotes. A relative projector.response in a file is taken relative to that
/// file. Throws Error: no_input (file missing), usage (an impossible --set), data (not TOML, unknown key, wrong type,
/// impossible value; with file, line and the nearest known key).
[[nodiscard]] model::Printer load_printer(const std::string& file, const std::vector<std::string>& sets);

/// Settings from TOML text, absent ones at their defaults. `subject` begins every message. Throws Fault::data.
[[nodiscard]] model::Printer parse_printer(std::string_view toml, const std::string& subject);

/// Commented TOML with every setting; parses back to the same settings, number for number.
[[nodiscard]] std::string printer_toml(const model::Printer& printer);

}  // namespace vam::io
