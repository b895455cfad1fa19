// SPDX-License-Identifier: GPL-3.0-or-later
// Errors carry whose fault they are; the fault is the exit status (sysexits, man pages: EXIT STATUS).
#pragma once

#include <stdexcept>
#include <string>

namespace vam {

enum class Fault : int {
  judged = 1,      // a judged comparison failed (vam-score --require)
  usage = 64,      // wrong options; nothing was opened
  data = 65,       // bad input data
  no_input = 66,   // cannot open an input
  absent = 69,     // device not there
  bug = 70,        // ours
  memory = 71,     // out of memory
  no_output = 73,  // cannot create an output
  io = 74,         // read or write failed, the final flush included
  busy = 75,       // locked or timed out; try again
  protocol = 76,   // an invalid answer of a device
};

/// One line for the user: subject, problem with numbers, remedy. "part.stl: 12 boundary edges; --repair closes them".
struct Error : std::runtime_error {
  Error(Fault whose, const std::string& line) : std::runtime_error(line), fault(whose) {}
  Fault fault;
};

}  // namespace vam
