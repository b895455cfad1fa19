// SPDX-License-Identifier: GPL-3.0-or-later
// Lines on standard output for the next tool of a pipe.
#pragma once

#include <string>

namespace vam::device {

/// Writes the line and flushes: the reader acts on it now. Throws Fault::io. A reader that is gone ends the process
/// (SIGPIPE), and the guardian does the rest.
void print_line(const std::string& line);

}  // namespace vam::device
