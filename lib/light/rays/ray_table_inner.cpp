// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the ray table within the reach: every point has one ray from each side.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/rays/private/chief_ray_dose.hpp"
#include "light/rays/private/ray_table.hpp"

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

TableNode RayTable::inner_node(const ChiefRayDose& light, double r_mm, double alpha, double& b_rad) const {
  const ChiefRayDose::OnCircle point = level_ray(light, r_mm, alpha, b_rad);
  const double zoom = climbs_ ? light.low_zoom(point.x_p_mm, point.u_mm) : 1;
  const FoundRay level{true,
                       point.x_p_mm,
                       zoom,
                       point.dose() * zoom,
                       light.spacing(1 / (point.ray.jacobian * point.alpha_rate)),
                       point.ray.delta_rad};
  return climbs_ ? node_over_heights(light, r_mm * std::cos(alpha), r_mm * std::sin(alpha), level)
                 : node_of(level, level, level);
}

/// From alpha = 0 to a quarter of a turn either way. The other half of the circle is its mirror image: vial and lens
/// are symmetric about the plane of the light's axis.
void RayTable::fill_inner_row(const ChiefRayDose& light, int row) {
  TableNode* nodes = row_of(inner, row, 0);
  for (const int way : {1, -1}) {
    double b = 0;
    for (int step = 0; step <= directions / 4; ++step) {
      const int index = way * step;
      const double alpha = scope_.sense * index * (2 * std::numbers::pi) / directions;
      TableNode node = inner_node(light, row * inner.pitch_mm, alpha, b);
      nodes[(index + directions) % directions] = node;
      for (float& x_p : node.x_p) x_p = -x_p;
      node.sine = -node.sine;
      nodes[directions / 2 - index] = node;
    }
  }
}

}  // namespace vam::light
