// SPDX-License-Identifier: GPL-3.0-or-later
// The clock of --budget.
#pragma once

#include "optimize/run/run_method.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Begins now.
[[nodiscard]] optimize::Deadline deadline_of(const Options& options);

/// So much of the time that is left, and little to be done after it.
[[nodiscard]] optimize::Deadline share_of(optimize::Deadline deadline, double share);

}  // namespace vam::optimize_tool
