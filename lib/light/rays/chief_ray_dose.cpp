// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/chief_ray_dose.hpp"

#include <algorithm>
#include <cmath>

#include "model/absorption.hpp"
#include "model/circle.hpp"
#include "optics/skew_ray.hpp"

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

}  // namespace vam::light
