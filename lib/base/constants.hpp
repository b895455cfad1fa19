// SPDX-License-Identifier: GPL-3.0-or-later
// Angles are degrees outside and radians inside a function; these constants are the border.
#pragma once

#include <numbers>

namespace vam {
inline constexpr double rad_per_deg = std::numbers::pi / 180.0;
inline constexpr double turn_rad = 2 * std::numbers::pi;
inline constexpr double deg_per_rad = 180.0 / std::numbers::pi;
}  // namespace vam
