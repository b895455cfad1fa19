// SPDX-License-Identifier: GPL-3.0-or-later
// The vial from above: the dose so far, turned as the stage has turned it, and the light that comes now.
#pragma once

#include <string>

#include "vam-status/light_view.hpp"
#include "vam-status/progress.hpp"

namespace vam::status_tool {

/// A figure in HTML. Light comes from below, x is to the right, as in [physics §1].
[[nodiscard]] std::string overhead_figure(const RunFolder& run, const LightView& light, bool lit);

}  // namespace vam::status_tool
