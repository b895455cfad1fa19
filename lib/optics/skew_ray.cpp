// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/skew_ray.hpp"

#include <algorithm>
#include <cmath>

#include "optics/private/fresnel.hpp"

namespace vam::optics {

namespace {

double square(double x) { return x * x; }

/// In front of the vial, in the medium of index n that surrounds it.
struct Incident {
  double s = 0;              // n sin(elevation), the invariant
  double impact_mm = 0;      // of the plan view, signed
  double phi_rad = 0;        // of the plan view, from the optical axis
  double height_mm = 0;      // at the point of the plan view that is nearest to the rotation axis
  double transmittance = 1;  // of the window
};

Incident incident(const View& view, double x_p, double z_p, const Slopes& slopes, const Displacement& vial) {
  const auto [slope_x, slope_z] = slopes;
  const double forward = 1 / std::sqrt(1 + square(slope_x) + square(slope_z));  // cosine of the angle with the axis
  const double n = view.bath_index;
  const double window = n == 1.0 ? 0.0 : view.window_mm;
  // Refraction at the flat window keeps the tangential components, in units of the index.
  const double across = slope_x * forward / n;
  const double up = slope_z * forward / n;
  const double along = std::sqrt(1 - square(across) - square(up));
  const double level = std::hypot(across, along);
  const double sine = across / level;
  const double cosine = along / level;
  const double x_w = x_p - window * slope_x - vial.x_mm;  // where the ray meets the window, seen from the vial's axis
  const double y_w = -(window + vial.y_mm);
  const double u_w = x_w * sine + y_w * cosine;
  Incident ray;
  ray.s = n * up;
  ray.impact_mm = x_w * cosine - y_w * sine;
  ray.phi_rad = std::asin(sine);
  ray.height_mm = z_p - window * slope_z - u_w * up / level;
  ray.transmittance = fresnel(1, forward, n, along);
  return ray;
}

}  // namespace

double SkewRay::steepness() const { return std::sqrt(1 + square(climb)); }

Slopes chief_slopes(const View& view, double x_p_mm, double z_p_mm) {
  return {view.lens_mm ? x_p_mm / *view.lens_mm : 0, view.rows_lens_mm ? z_p_mm / *view.rows_lens_mm : 0};
}

SkewRay skew_ray(const View& view, double x_p_mm, double z_p_mm, const Displacement& vial) {
  return ray_of_slopes(view, x_p_mm, z_p_mm, chief_slopes(view, x_p_mm, z_p_mm), vial);
}

SkewRay ray_of_slopes(const View& view, double x_mm, double z_mm, const Slopes& slopes, const Displacement& vial) {
  const Incident before = incident(view, x_mm, z_mm, slopes, vial);
  SkewRay ray{true, before.impact_mm, -before.phi_rad, before.height_mm, 0, before.transmittance};
  double index = view.bath_index;
  double level = std::sqrt(square(index) - square(before.s));  // n cos(elevation): the index of the plan view
  for (const Shell& shell : view.shells) {
    const double inside = std::sqrt(square(shell.index) - square(before.s));
    const double sin_in = ray.offset_mm / shell.radius_mm;
    const double sin_out = sin_in * level / inside;
    if (!(std::abs(sin_in) < 1 && std::abs(sin_out) < 1)) return {};
    const double cos_in = std::sqrt((1 - sin_in) * (1 + sin_in));
    const double cos_out = std::sqrt((1 - sin_out) * (1 + sin_out));
    ray.delta_rad += std::asin(sin_in) - std::asin(sin_out);
    // The height is that of the way in the new medium, continued backwards to u = 0: both ways meet at the wall.
    ray.height_mm += shell.radius_mm * before.s * (cos_out / inside - cos_in / level);
    ray.transmittance *= fresnel(index, cos_in * level / index, shell.index, cos_out * inside / shell.index);
    ray.offset_mm = shell.radius_mm * sin_out;
    index = shell.index;
    level = inside;
  }
  ray.climb = before.s / level;
  return ray;
}

View plan_view(const View& view, double z_p_mm) {
  if (!view.rows_lens_mm) return view;
  const double sine = z_p_mm / std::hypot(*view.rows_lens_mm, z_p_mm);
  const double s2 = square(sine);
  const auto level = [s2](double index) { return std::sqrt((square(index) - s2) / (1 - s2)); };
  View plan = view;
  if (plan.bath_index != 1.0) plan.bath_index = level(plan.bath_index);
  for (auto& shell : plan.shells) shell.index = level(shell.index);
  return plan;
}

RayAt ray_through(const View& view, double x_mm, double y_mm, double z_mm, double x_p_guess_mm, double z_p_guess_mm,
                  const Displacement& vial) {
  constexpr double h = 1e-4;  // mm: central differences to 1e-9
  struct Miss {
    double across, height;  // from the point to the ray
    SkewRay ray;
  };
  const auto miss = [&](double x_p, double z_p) -> Miss {
    const SkewRay ray = skew_ray(view, x_p, z_p, vial);
    const double c = std::cos(ray.delta_rad);
    const double s = std::sin(ray.delta_rad);
    return {ray.offset_mm - (x_mm * c + y_mm * s), ray.z_mm(y_mm * c - x_mm * s) - z_mm, ray};
  };
  RayAt at{{}, x_p_guess_mm, z_p_guess_mm, 0, 0};
  for (int step = 0; step < 30; ++step) {
    const Miss here = miss(at.x_p_mm, at.z_p_mm);
    const Miss right = miss(at.x_p_mm + h, at.z_p_mm);
    const Miss left = miss(at.x_p_mm - h, at.z_p_mm);
    const Miss above = miss(at.x_p_mm, at.z_p_mm + h);
    const Miss below = miss(at.x_p_mm, at.z_p_mm - h);
    if (!here.ray.hits || !right.ray.hits || !left.ray.hits || !above.ray.hits || !below.ray.hits) return {};
    const double across_x = (right.across - left.across) / (2 * h);
    const double across_z = (above.across - below.across) / (2 * h);
    const double height_x = (right.height - left.height) / (2 * h);
    const double height_z = (above.height - below.height) / (2 * h);
    const double area = across_x * height_z - across_z * height_x;
    const double move_x = (here.across * height_z - here.height * across_z) / area;
    const double move_z = (here.height * across_x - here.across * height_x) / area;
    at.ray = here.ray;
    at.spacing = 1 / std::abs(across_x);
    at.density = here.ray.steepness() / std::abs(area);
    if (std::abs(move_x) + std::abs(move_z) < 1e-9) return at;
    at.x_p_mm -= std::clamp(move_x, -1.0, 1.0);
    at.z_p_mm -= std::clamp(move_z, -1.0, 1.0);
  }
  return {};
}

}  // namespace vam::optics
