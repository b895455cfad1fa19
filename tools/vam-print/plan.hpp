// SPDX-License-Identifier: GPL-3.0-or-later
// --plan: what can be known of a print before it, a line each.
#pragma once

#include "vam-print/run.hpp"

namespace vam::print_tool {

/// Prints every line that can be had; returns the status of the first that failed.
[[nodiscard]] int print_plan(Run& run);

}  // namespace vam::print_tool
