// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the ray table within the reach: every point has one ray from each side.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/rays/private/ray_table.hpp"
#include "light/rays/private/skew_ray_dose.hpp"

namespace vam::light {

namespace {

/// The level ray that has direction alpha at radius r; b is where to begin, and where it was found. alpha(b) is
/// monotone here: a few steps. Halving guards the rim, where delta is steepest.
ChiefRayDose::OnCircle level_ray(const ChiefRayDose& light, double r_mm, double alpha, double& b) {
  ChiefRayDose::OnCircle point = light.at(r_mm, b);
  for (int step = 0; step < 60 && std::abs(alpha - point.alpha) > 1e-12; ++step) {
    const double limit = 0.25 / (1 + step);
    b += std::clamp((alpha - point.alpha) / point.alpha_rate, -limit, limit);
    point = light.at(r_mm, b);
  }
  return point;
}

}  // namespace

void RayTable::fill_inner_row(const ChiefRayDose& light, int row) {
  const double r = row * inner.pitch_mm;
  double b = 0;
  for (int index = 0; index < directions; ++index) {
    const double alpha = scope_.sense * index * (2 * std::numbers::pi) / directions;
    const ChiefRayDose::OnCircle point = level_ray(light, r, alpha, b);
    const double zoom = climbs_ ? light.low_zoom(point.x_p_mm, point.u_mm) : 1;
    const FoundRay level{true,
                         point.x_p_mm,
                         zoom,
                         point.dose() * zoom,
                         light.spacing(1 / (point.ray.jacobian * point.alpha_rate)),
                         point.ray.delta_rad};
    row_of(inner, row, 0)[index] = climbs_ ? node_over_heights(light, r * std::cos(alpha), r * std::sin(alpha), level)
                                           : node_of(level, level, level);
  }
}

}  // namespace vam::light
