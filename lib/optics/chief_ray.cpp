// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/chief_ray.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "optics/private/fresnel.hpp"
#include "optics/skew_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::optics {

namespace {

// The ray in front of the vial, in the medium n_0 that surrounds it.
struct Approach {
  double impact_mm = 0;      // b, signed distance from the axis
  double phi_rad = 0;        // angle with the optical axis, in n_0
  double impact_rate = 1;    // db / dx_p
  double phi_rate = 0;       // dphi / dx_p, rad/mm
  double transmittance = 1;  // of the window
};

Approach approach(const View& view, double x_p) {
  if (!view.lens_mm) {  // telecentric: square on the window
    return {x_p, 0, 1, 0, fresnel(1, 1, view.bath_index, 1)};
  }
  const double d = *view.lens_mm;
  const double l = view.bath_index == 1.0 ? 0.0 : view.window_mm;
  const double tan_phi = x_p / d;
  const double cos_phi = 1.0 / std::sqrt(1.0 + tan_phi * tan_phi);
  const double sin_b = tan_phi * cos_phi / view.bath_index;  // sin phi_b = sin phi / n_b [RAY21 appendix 1]
  const double cos_b = std::sqrt(1.0 - sin_b * sin_b);
  const double x_w = x_p * (1.0 - l / d);  // where the ray meets the window
  Approach ray;
  ray.impact_mm = x_w * cos_b + l * sin_b;
  ray.phi_rad = std::asin(sin_b);
  ray.phi_rate = cos_phi * cos_phi * cos_phi / (d * view.bath_index * cos_b);
  ray.impact_rate = (1.0 - l / d) * cos_b + (l * cos_b - x_w * sin_b) * ray.phi_rate;
  ray.transmittance = fresnel(1, cos_phi, view.bath_index, cos_b);
  return ray;
}

void check(const View& view) {
  const double radius = view.shells.front().radius_mm;
  const auto mm = [](double value) { return format_number(value) + " mm"; };
  double outside = radius;
  for (const Shell& shell : view.shells) {
    if (!(shell.radius_mm > 0 && shell.radius_mm <= outside)) {
      throw Error{Fault::data, "vial: an inner radius of " + mm(shell.radius_mm) + " exceeds the outer radius of " +
                                   mm(outside) + "; check vial.radius_mm and vial.wall_mm"};
    }
    outside = shell.radius_mm;
  }
  const std::optional<double> lens_mm = view.lens_mm ? view.lens_mm : view.rows_lens_mm;
  if (!lens_mm) return;
  if (!(*lens_mm > radius)) {
    throw Error{Fault::data, "lens: " + mm(*lens_mm) + " from the axis is inside the vial of " + mm(radius) +
                                 "; increase projector.throw_ratio or set projector.telecentric"};
  }
  if (view.bath_index == 1.0) return;
  if (!(view.window_mm >= radius && view.window_mm < *lens_mm)) {
    throw Error{Fault::data, "bath: its window is " + mm(view.window_mm) + " before the axis, but the vial ends at " +
                                 mm(radius) + " and the lens is at " + mm(*lens_mm) + "; set bath.window_mm"};
  }
}

View make_view(const model::Printer& printer, std::optional<double> columns_lens_mm, std::optional<double> rows_lens_mm,
               double index_resin) {
  View view;
  view.lens_mm = columns_lens_mm;
  view.rows_lens_mm = rows_lens_mm;
  view.bath_index = printer.bath.index;
  view.window_mm = printer.bath.window_mm;
  if (printer.vial.wall_mm > 0) view.shells.push_back({printer.vial.radius_mm, printer.vial.index_glass});
  view.shells.push_back({model::resin_radius_mm(printer.vial), index_resin});
  check(view);
  return view;
}

}  // namespace

View projector_view(const model::Printer& printer) {
  return make_view(printer, model::columns_lens_mm(printer.projector), model::rows_lens_mm(printer.projector),
                   printer.resin.index);
}

View camera_view(const model::Printer& printer) {
  const auto lens_mm = printer.camera.telecentric ? std::nullopt : std::optional(printer.camera.distance_mm);
  return make_view(printer, lens_mm, lens_mm, printer.camera.index_resin);
}

namespace {

/// Rays that graze an interface miss, or cosines were 0 and rates and transmittances 0 / 0.
bool passes(const View& view, double nb) {
  constexpr double grazing = 1 - 1e-10;
  return std::abs(nb) < grazing * largest_invariant(view);
}

/// The ray of the invariant nb = n b, which passes.
ChiefRay ray_inside(const View& view, const Approach& before, double nb) {
  ChiefRay ray{true, 0, -before.phi_rad, before.transmittance, 0, -before.phi_rate};
  const double nb_rate = view.bath_index * before.impact_rate;
  double n = view.bath_index;
  for (const Shell& shell : view.shells) {
    const double sin_in = nb / (n * shell.radius_mm);
    const double sin_out = nb / (shell.index * shell.radius_mm);
    const double cos_in = std::sqrt((1.0 - sin_in) * (1.0 + sin_in));
    const double cos_out = std::sqrt((1.0 - sin_out) * (1.0 + sin_out));
    ray.delta_rad += std::asin(sin_in) - std::asin(sin_out);
    ray.delta_rate += nb_rate / shell.radius_mm * (1.0 / (n * cos_in) - 1.0 / (shell.index * cos_out));
    ray.transmittance *= fresnel(n, cos_in, shell.index, cos_out);
    n = shell.index;
  }
  ray.x_v_mm = nb / n;  // (n_0 / n_last) b
  ray.jacobian = nb_rate / n;
  return ray;
}

}  // namespace

ChiefRay chief_ray(const View& view, double x_p_mm) {
  const Approach before = approach(view, x_p_mm);
  const double nb = view.bath_index * before.impact_mm;
  return passes(view, nb) ? ray_inside(view, before, nb) : ChiefRay{};
}

double column_of_impact(const View& view, double impact_mm) {
  if (!view.lens_mm) return impact_mm;
  if (view.bath_index == 1.0) {  // b = x_p cos(atan(x_p / D_p)) solved for x_p
    const double sine = impact_mm / *view.lens_mm;
    return impact_mm / std::sqrt((1.0 - sine) * (1.0 + sine));
  }
  // b is monotone and nearly linear in x_p: Newton settles in a handful of steps.
  double x_p = impact_mm;
  for (int step = 0; step < 50; ++step) {
    const Approach ray = approach(view, x_p);
    const double move = (impact_mm - ray.impact_mm) / ray.impact_rate;
    x_p += move;
    if (std::abs(move) <= 1e-14 * view.shells.front().radius_mm) break;
  }
  return x_p;
}

std::optional<ColumnRay> column_of(const View& view, double x_v_mm) {
  const double nb = x_v_mm * view.shells.back().index;
  if (!passes(view, nb)) return std::nullopt;
  const double x_p_mm = column_of_impact(view, nb / view.bath_index);
  return ColumnRay{x_p_mm, ray_inside(view, approach(view, x_p_mm), nb)};
}

ColumnRay edge_column(const View& view) { return column_of(view, rim * reach_mm(view)).value(); }

double resin_radius_mm(const View& view) { return view.shells.back().radius_mm; }

double impact_mm(const View& view, double x_p_mm) { return approach(view, x_p_mm).impact_mm; }

double displacement_rate(const View& view, double x_p_mm) {
  const Approach ray = approach(view, x_p_mm);  // of a vial at x: b - x cos phi stays
  return ray.impact_rate / std::cos(ray.phi_rad);
}

Bundle bundle(const View& view, double x_p_mm, double focus_mm) {
  constexpr double small_rad = 1e-5;  // central differences to 1e-9
  const double slope = chief_slopes(view, x_p_mm, 0).x;
  const auto beside = [&](double angle_rad) {
    const double other = std::tan(std::atan(slope) + angle_rad);
    return ray_of_slopes(view, x_p_mm - focus_mm * (other - slope), 0, {other, 0});
  };
  const SkewRay right = beside(small_rad);
  const SkewRay left = beside(-small_rad);
  const double climb = small_rad * std::sqrt(1 + slope * slope);
  const SkewRay above = ray_of_slopes(view, x_p_mm, -focus_mm * climb, {slope, climb});
  if (!right.hits || !left.hits || !above.hits) return {};
  return {true, (right.offset_mm - left.offset_mm) / (2 * small_rad),
          (right.delta_rad - left.delta_rad) / (2 * small_rad), above.height_mm / small_rad, above.climb / small_rad};
}

}  // namespace vam::optics
