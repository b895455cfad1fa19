// SPDX-License-Identifier: GPL-3.0-or-later
// Whether light that was computed for one printer prints in another.
#pragma once

#include <string>
#include <vector>

#include "model/printer.hpp"

namespace vam::io {

/// The printer of a text of printer_settings, the attribute vam:printer of a stack. Settings that this version does not
/// have are left out. `subject` begins every message. Throws as parse_printer() does.
[[nodiscard]] model::Printer parse_settings(const std::string& text, const std::string& subject,
                                            const std::vector<std::string>& sets = {});

/// What a key of the printer decides: where light falls, how much of it, or anything of the print.
enum class Matter { light, dose, any };

/// Where two printers differ in what bends, shifts, widens or weakens a projection, by more than a print can bear:
/// "vial.radius_mm 12.7, now 6"; in speed or full intensity, which decide the dose of a turn; to four digits, in any
/// other key but those that decide neither light nor dose. Without differences of light frames for the one serve the
/// other: vam-project applies anew what else there is [formats: Attributes of volumes and prints].
[[nodiscard]] std::vector<std::string> differences(model::Printer computed_for, model::Printer now, Matter up_to);

}  // namespace vam::io
