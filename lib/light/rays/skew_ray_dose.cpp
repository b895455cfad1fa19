// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/skew_ray_dose.hpp"

#include <cmath>

namespace vam::light {

namespace {

constexpr double middle_height = 0.6;  // of the largest: where the polynomials are exact besides 0 and 1

/// The polynomial in z^2 that takes these values at z = 0, middle_height and 1 (in units of the largest height).
TableNode::Even even_fit(double at_0, double at_middle, double at_1) {
  constexpr double m = middle_height * middle_height;
  const double a = (at_middle - at_0) / m;  // c1 + c2 m
  const double b = at_1 - at_0;             // c1 + c2
  const double c2 = (b - a) / (1 - m);
  return {static_cast<float>(at_0), static_cast<float>(b - c2), static_cast<float>(c2)};
}

}  // namespace

FoundRay ray_at(const ChiefRayDose& light, double x_mm, double y_mm, double z_mm, const FoundRay& level,
                const optics::Displacement& vial) {
  const optics::RayAt found =
      optics::ray_through(light.scope.view, x_mm, y_mm, z_mm, level.x_p_mm, z_mm * level.row, vial);
  const optics::SkewRay& ray = found.ray;
  if (!ray.hits) return {false, level.x_p_mm, level.row, 0, level.spacing, level.delta_rad};
  const double u = y_mm * std::cos(ray.delta_rad) - x_mm * std::sin(ray.delta_rad);
  return {true,
          found.x_p_mm,
          found.z_p_mm / z_mm,
          ray.transmittance * found.density * light.transmitted(ray.offset_mm, u, ray.steepness()),
          light.spacing(found.spacing),
          ray.delta_rad};
}

TableNode node_of(const FoundRay& level, const FoundRay& middle, const FoundRay& top) {
  return {even_fit(level.x_p_mm, middle.x_p_mm, top.x_p_mm),       even_fit(level.row, middle.row, top.row),
          even_fit(level.strength, middle.strength, top.strength), even_fit(level.spacing, middle.spacing, top.spacing),
          static_cast<float>(std::cos(level.delta_rad)),           static_cast<float>(std::sin(level.delta_rad))};
}

TableNode node_over_heights(const ChiefRayDose& light, double x_mm, double y_mm, const FoundRay& level,
                            const optics::Displacement& vial) {
  const double height_mm = light.scope.height_mm;
  return node_of(level, ray_at(light, x_mm, y_mm, height_mm * middle_height, level, vial),
                 ray_at(light, x_mm, y_mm, height_mm, level, vial));
}

}  // namespace vam::light
