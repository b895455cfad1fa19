// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the ray table beyond the writable radius, where rays fold into caustics: filled ray by ray, which conserves
// the power [physics §4].
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/index.hpp"
#include "light/rays/private/chief_ray_dose.hpp"
#include "light/rays/private/ray_table.hpp"

namespace vam::light {

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr int samples_per_step = 8;  // rays per step of alpha where the map folds

/// The rays that were counted for a direction.
struct Cell {
  double strength = 0;
  double x_p = 0, zoom = 0, cosine = 0, sine = 0, spacing = 0;  // weighted by strength
};
using RaySheet = std::vector<Cell>;

/// visit(sheet, point): rays at equal steps of b from one side, the sheet one further after every fold.
template <class Visit>
void each_ray(const ChiefRayDose& light, double r_mm, double first_rad, double step_rad, int samples, int sheet,
              const Visit& visit) {
  bool rising = true;
  for (int k = 0; k < samples; ++k) {
    const ChiefRayDose::OnCircle point = light.at(r_mm, first_rad + (k + 0.5) * step_rad);
    if (k == 0) rising = point.alpha_rate > 0;
    if ((point.alpha_rate > 0) != rising) {
      rising = !rising;
      sheet = std::min(sheet + 1, RayTable::most_sheets - 1);
    }
    visit(sheet, point);
  }
}

/// Counts a ray for the two directions nearest to its own, `place` in steps of the table.
void share_out(const ChiefRayDose& light, const ChiefRayDose::OnCircle& point, double zoom, double strength,
               double place, RaySheet& sheet) {
  const auto directions = count_of(sheet);
  const double below = std::floor(place);
  for (const int side : {0, 1}) {
    const double share = strength * (side == 1 ? place - below : 1 - (place - below));
    const int index = (static_cast<int>(below) + side) % directions;
    Cell& cell = sheet[(index + directions) % directions];
    cell.strength += share;
    cell.x_p += share * point.x_p_mm;
    cell.zoom += share * zoom;
    cell.cosine += share * std::cos(point.ray.delta_rad);
    cell.sine += share * std::sin(point.ray.delta_rad);
    cell.spacing += share * light.spacing(1 / point.ray.jacobian);
  }
}

/// The mean ray of a direction. One without a ray takes its neighbour's, so that interpolation to it only fades.
TableNode mean_of(const RaySheet& sheet, int index) {
  const auto directions = count_of(sheet);
  const auto cell = [&](int i) { return sheet[(i + directions) % directions]; };
  Cell source = cell(index);
  for (const int neighbour : {-1, 1}) {
    if (source.strength == 0) source = cell(index + neighbour);
  }
  if (!(source.strength > 0)) return {};
  const auto mean = [&](double sum) { return static_cast<float>(sum / source.strength); };
  return {{mean(source.x_p), 0, 0},     {mean(source.zoom), 0, 0}, {static_cast<float>(cell(index).strength), 0, 0},
          {mean(source.spacing), 0, 0}, mean(source.cosine),       mean(source.sine)};
}

}  // namespace

void RayTable::fill_outer_row(const ChiefRayDose& light, int row) {
  const double r = outer.first_mm + row * outer.pitch_mm;
  // Rays reach b in (open, pi - open) and opposite.
  const double open = std::acos(std::min(1.0, ChiefRayDose::rim * reach_mm / r));
  const double arc = std::numbers::pi - 2 * open;
  const int samples = std::max(8, ceil_int(samples_per_step * directions * arc / turn_rad));
  const double step = arc / samples;
  std::array<RaySheet, most_sheets> sheets;
  sheets.fill(RaySheet(directions));
  const auto add = [&](int sheet, const ChiefRayDose::OnCircle& point) {
    const double zoom = climbs_ ? light.low_zoom(point.x_p_mm, point.u_mm) : 1.0;
    const double strength = point.strength * zoom * step * directions / turn_rad;
    share_out(light, point, zoom, strength, scope_.sense * point.alpha * directions / turn_rad, sheets[sheet]);
  };
  each_ray(light, r, -std::numbers::pi + open, step, samples, 0, add);  // light enters at u < 0
  each_ray(light, r, open, step, samples, 1, add);
  for (int sheet = 0; sheet < most_sheets; ++sheet) {
    for (int index = 0; index < directions; ++index) row_of(outer, row, sheet)[index] = mean_of(sheets[sheet], index);
  }
}

}  // namespace vam::light
