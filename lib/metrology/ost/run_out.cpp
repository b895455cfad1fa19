// SPDX-License-Identifier: GPL-3.0-or-later
// Run-out: which heights show it, what it does to the views, and its fit [physics §8].
#include "metrology/ost/run_out.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "metrology/ost/ost.hpp"
#include "metrology/ost/private/angle_grid.hpp"
#include "metrology/ost/private/camera_sinograms.hpp"
#include "metrology/ost/private/line_pairs.hpp"
#include "metrology/ost/private/ost_state.hpp"
#include "optics/chief_ray.hpp"

namespace vam::metrology {

std::vector<ColumnMotion> OstReconstructor::State::motion(std::span<const double> angles_deg, double x_mm,
                                                          double y_mm) const {
  // In the bath a column at x mm of the axis plane is at x m mm, and its ray leans by x / (n D).
  constexpr double near_mm = 1e-3;
  const double m = optics::impact_mm(eye.view, near_mm) / near_mm;
  const double reach_mm = eye.view.lens_mm ? m * eye.view.bath_index * *eye.view.lens_mm : 0.0;
  std::vector<ColumnMotion> all;
  for (const double phi : part_angles_rad(angles_deg)) {
    const double across_mm = std::cos(phi) * x_mm + std::sin(phi) * y_mm;
    const double away_mm = std::cos(phi) * y_mm - std::sin(phi) * x_mm;
    all.push_back({across_mm / (m * eye.camera.pixel_mm), reach_mm > 0 ? -away_mm / reach_mm : 0.0});
  }
  return all;
}

std::vector<double> OstReconstructor::State::part_angles_rad(std::span<const double> angles_deg) const {
  std::vector<double> all;
  for (const double angle : angles_deg) all.push_back(direction * angle * rad_per_deg + azimuth_rad);
  return all;
}

std::vector<double> OstReconstructor::State::lean_rad() const {
  std::vector<double> all;
  for (int x = 0; x < eye.camera.columns; ++x) {
    all.push_back(optics::chief_ray(eye.view, eye.camera.x_mm(x)).delta_rate * eye.camera.pixel_mm);
  }
  return all;
}

RunOut OstReconstructor::find_run_out(std::span<const CameraView> views) const {
  const State& s = *state_;
  RunOut found;
  if (!s.options.refraction) return found;
  const std::vector<double> angles_deg = metrology::angles_deg(views);
  const Turns turns(angles_deg);
  const RowOfHeight map(s.eye);
  const Image mean = mean_view(views);
  constexpr std::size_t most_heights = 32;
  const auto heights_mm = print_heights(mean, map, s.eye, s.grid, most_heights);
  if (heights_mm.empty()) return found;
  const double background = even_background(mean).background;
  const Flicker light = s.flicker(views, mean, angles_deg, background);
  const auto level = s.steady_views(views, map, heights_mm, background, light.intensity);
  const double unit_mm = s.eye.camera.pixel_mm;
  const PairBasis basis{{std::vector<ColumnMotion>(views.size(), {1, 0}), s.motion(angles_deg, unit_mm, 0),
                         s.motion(angles_deg, 0, unit_mm)},
                        s.axis.column,
                        s.part_angles_rad(angles_deg),
                        s.lean_rad(),
                        !light.intensity.empty()};
  const SinogramsOf sinograms_of = [&](const std::vector<Image>& moved) {
    return s.virtual_sinograms(camera_sinograms(moved, turns), heights_mm);
  };
  PairFit fit = fit_line_pairs(level, basis, pair_unknowns, sinograms_of);
  if (!fit.converged) fit = fit_line_pairs(level, basis, pair_motions, sinograms_of);  // where bubbles pass
  found.determined = fit.converged;
  found.mm = {s.options.run_out_mm[0] + fit.value[1] * unit_mm, s.options.run_out_mm[1] + fit.value[2] * unit_mm};
  // Both are seen by the same lines; what these say of one alone is little for a standard deviation.
  // Absorption is fitted to the first order, which leaves up to 0.015 mm at 0.1 per mm; what is interpolated between
  // columns and angles, up to 0.025 columns of ideal views.
  constexpr double left_mm2 = 0.1;
  constexpr double left_columns = 0.02;
  found.sigma_mm = std::hypot(unit_mm * std::hypot(fit.sigma[1], fit.sigma[2]) / std::numbers::sqrt2,
                              left_mm2 * s.absorption_per_mm, left_columns * unit_mm);
  found.column = s.axis.column + fit.value[0];
  found.column_sigma = fit.sigma[0];
  const bool is_given = s.absorption_per_mm > 0;
  if (fit.converged && !is_given) {
    found.absorption_per_mm = fit.value[pair_motions] / s.grid.voxel_mm;
    found.absorption_sigma_per_mm = fit.sigma[pair_motions] / s.grid.voxel_mm;
  }
  // A quarter of the fit's time, so only where it matters.
  if (found.absorbs() || (found.seen() && !motion_explains(level, basis, fit.value, sinograms_of))) {
    found.determined = false;
  }
  return found;
}

double RunOut::size_mm() const { return std::hypot(mm[0], mm[1]); }

bool RunOut::seen() const {
  constexpr double sigmas = 3.44;  // of two components: as rarely exceeded by chance as 3 by one
  return determined && size_mm() > sigmas * sigma_mm;
}

bool RunOut::absorbs() const {
  constexpr double least_per_mm = 0.005;  // 5 % over a print of 10 mm
  constexpr double sigmas = 3;
  return absorption_per_mm > std::max(least_per_mm, sigmas * absorption_sigma_per_mm);
}

Json to_json(const RunOut& found) {
  if (!found.determined) return nullptr;
  return {{"x_mm", found.mm[0]},          {"y_mm", found.mm[1]},        {"x_sigma_mm", found.sigma_mm},
          {"y_sigma_mm", found.sigma_mm}, {"size_mm", found.size_mm()}, {"size_sigma_mm", found.sigma_mm},
          {"removed", found.seen()}};
}

}  // namespace vam::metrology
