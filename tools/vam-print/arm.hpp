// SPDX-License-Identifier: GPL-3.0-or-later
// Before anything moves or is lit: records, settings and devices are in order.
#pragma once

#include "vam-print/run.hpp"

namespace vam::print_tool {

/// Makes the folder of the run, which no other print has. Throws Fault::no_output.
void make_folder(Run& run);

/// Freezes the settings in the folder of the run and asks every device. Throws Error and Ended; what is refused is
/// said.
void arm(Run& run);

/// --plan: the same steps in a folder of their own, each with what can be known of the print, also where one fails.
/// Returns the status of the first that failed.
[[nodiscard]] int print_plan(Run& run);

}  // namespace vam::print_tool
