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

/// Where two printers differ in what bends, shifts, widens or weakens a projection, by more than a print can bear:
/// "vial.radius_mm 12.7, now 6". Empty where frames for the one serve the other. What vam-project applies anew (grey
/// response, rows, orientation, speed) is not compared [formats: Attributes of volumes and prints].
[[nodiscard]] std::vector<std::string> light_differences(const model::Printer& computed_for, const model::Printer& now);

/// The same, and where they differ in speed or full intensity, which decide the dose of a turn.
[[nodiscard]] std::vector<std::string> dose_differences(const model::Printer& computed_for, const model::Printer& now);

}  // namespace vam::io
