// SPDX-License-Identifier: GPL-3.0-or-later
// Whether light that was computed for one printer prints in another.
#pragma once

#include <string>
#include <vector>

#include "model/printer.hpp"

namespace vam::io {

/// The printer of a text of printer_settings, the attribute vam:printer of a stack. Settings that this version does not
/// have are left out. `subject` begins every message. Throws Fault::data.
[[nodiscard]] model::Printer parse_settings(const std::string& text, const std::string& subject);

/// Where two printers differ in what bends, shifts or weakens a projection, by more than a print can bear:
/// "vial.radius_mm 12.7, now 6". Empty where frames for the one serve the other. What vam-project applies anew (grey
/// response, rows, orientation, speed) is not compared [formats: Attributes of volumes and prints].
[[nodiscard]] std::vector<std::string> light_differences(const model::Printer& computed_for, const model::Printer& now);

}  // namespace vam::io
