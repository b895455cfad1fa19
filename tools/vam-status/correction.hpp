// SPDX-License-Identifier: GPL-3.0-or-later
// What a print that corrects itself has found of resin and axis, and what it does about it (vam-correct renew).
#pragma once

#include <string>

#include "vam-status/progress.hpp"

namespace vam::status_tool {

/// "from turn 11 on, for 2 turns: sensitivity 0.95", or why there is none yet; empty of a print that does not.
[[nodiscard]] std::string correction_text(const RunFolder& run);

/// The sensitivity along x and z through the middle, a figure in HTML; empty while there is none.
[[nodiscard]] std::string sensitivity_figure(const RunFolder& run);

}  // namespace vam::status_tool
