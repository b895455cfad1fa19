// SPDX-License-Identifier: GPL-3.0-or-later
// Before anything moves or is lit: records, settings and devices are in order.
#pragma once

#include <string>

#include "vam-print/run.hpp"

namespace vam::print_tool {

/// Makes the run folder, freezes the settings in it and asks every device. Throws Error and Ended; what is refused is
/// said.
void arm(Run& run);

/// Makes the folder of the run, which no other print has. Throws Fault::no_output.
void make_folder(Run& run);

/// The settings of the print, calibration included, as the file `file`; those of a file that may have been cut off are
/// refused. Returns the status, and what is accepted is said.
int freeze_settings(Run& run, const std::string& file, bool accept_printer);

/// vam-ost refuses wrong options before it misses the views, of which it gets none here. Returns the status.
int check_metrology(const Run& run, const std::string& printer);

}  // namespace vam::print_tool
