// SPDX-License-Identifier: GPL-3.0-or-later
// No projector shows negative light: what becomes of it.
#pragma once

#include <string>
#include <vector>

#include "base/compute/slab.hpp"

namespace vam::tomo {

/// What is done about negative light [CAL17]: nothing, set to 0, or raised by the lowest value of the whole stack.
enum class Negative { keep, clip, offset };

/// The lowest value, at most 0.
[[nodiscard]] float lowest(const Slab& slab);

/// value = max(value + raise, floor).
void raise_and_clip(Slab& slab, float raise, float floor);

/// "keep", "clip", "offset" in the order of the enumeration.
[[nodiscard]] const std::vector<std::string>& negative_names();

}  // namespace vam::tomo
