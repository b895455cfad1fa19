// SPDX-License-Identifier: GPL-3.0-or-later
// Absorption along a ray [physics §4].
#pragma once

#include <cmath>

namespace vam::model {

/// Beer-Lambert's law: the share of the intensity that is left after a path; coefficient and path in the same unit.
[[nodiscard]] inline double transmitted(double absorption, double path) { return std::exp(-absorption * path); }

}  // namespace vam::model
