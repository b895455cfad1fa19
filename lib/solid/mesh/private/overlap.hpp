// SPDX-License-Identifier: GPL-3.0-or-later
// Where boxes overlap.
#pragma once

#include <vector>

#include "solid/mesh/geometry.hpp"

namespace vam::solid {

/// A box around all that two of the boxes share; empty when they only touch.
[[nodiscard]] Bounds overlap(std::vector<Bounds> boxes);

}  // namespace vam::solid
