// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/chief_ray_dose.hpp"

#include <algorithm>
#include <cmath>

#include "model/absorption.hpp"
#include "model/circle.hpp"

namespace vam::light {

ChiefRayDose::OnCircle ChiefRayDose::at(double r_mm, double b_rad) const {
  const double widest = optics::rim * reach_mm;
  const double t = std::clamp(r_mm * std::cos(b_rad), -widest, widest);
  const double u = r_mm * std::sin(b_rad);
  const auto [x_p, ray] = optics::column_of(scope.view, t).value();
  return {b_rad + ray.delta_rad,
          1 - u * ray.delta_rate / ray.jacobian,
          x_p,
          ray.transmittance / ray.jacobian * transmitted(t, u, 1),
          ray,
          u};
}

double ChiefRayDose::transmitted(double offset_mm, double u_mm, double steepness) const {
  const double s = model::half_chord(edge_mm, offset_mm) + u_mm;
  return model::transmitted(scope.absorption_per_mm, s * steepness);
}

double ChiefRayDose::spacing(double exact) const {
  constexpr double most = 2;  // of that on the axis
  return std::min(exact, most / optics::chief_ray(scope.view, 0).jacobian);
}

double ChiefRayDose::low_zoom(double x_p_mm, double u_mm) const {
  constexpr double low_mm = 1e-3;
  const optics::SkewRay ray = optics::skew_ray(scope.view, x_p_mm, low_mm);
  return ray.hits ? low_mm / ray.z_mm(u_mm) : 1.0;
}

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
