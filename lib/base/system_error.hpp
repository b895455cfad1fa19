// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of system calls.
#pragma once

#include <string>

#include "base/error.hpp"

namespace vam {

/// "x.vdb: cannot open: No such file or directory; `remedy`" of `what` and an errno. Too many open files are a lack of
/// the system, whatever is opened: Fault::memory, with the remedy for that.
[[nodiscard]] Error system_error(Fault fault, const std::string& what, int problem, const std::string& remedy = "");

}  // namespace vam
