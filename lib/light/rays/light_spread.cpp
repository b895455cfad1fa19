// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/light_spread.hpp"

#include <algorithm>
#include <cmath>

#include "optics/chief_ray.hpp"

namespace vam::light {

namespace {

constexpr int columns_of_table = 513;
constexpr double box_of_disc = 1.7320508075688772;  // the chords of a disc have the variance 1/4, a box of edge 1 1/12

}  // namespace

LightSpread::LightSpread(const VialSetup& setup)
    : hold_rad_(setup.hold_rad),
      half_angle_rad_(setup.half_angle_rad),
      rows_half_angle_rad_(setup.rows_half_angle_rad) {
  if (!(half_angle_rad_ > 0 || rows_half_angle_rad_ > 0)) return;
  constexpr double inside = 1 - 1e-3;  // at the rim one half of a bundle misses the resin
  const double edge_mm = inside * optics::edge_column(setup.view).x_p_mm;
  first_mm_ = static_cast<float>(-edge_mm);
  per_mm_ = static_cast<float>((columns_of_table - 1) / (2 * edge_mm));
  for (int c = 0; c < columns_of_table; ++c) {
    const double x_p = edge_mm * (2.0 * c / (columns_of_table - 1) - 1);
    const optics::Bundle rays = optics::bundle(setup.view, x_p, setup.focus_mm);
    const auto wide = [](double rate, double half_angle) { return static_cast<float>(rate * half_angle); };
    const double box_rad = box_of_disc * half_angle_rad_;
    const double sigma_rad = 0.5 * rows_half_angle_rad_;
    columns_.push_back({{wide(-rays.offset_rate_mm, box_rad), wide(rays.delta_rate, box_rad)},
                        {wide(rays.height_rate_mm, sigma_rad), wide(rays.climb_rate, sigma_rad)}});
  }
}

const LightSpread::Column& LightSpread::column(float x_p_mm) const {
  const float place = (x_p_mm - first_mm_) * per_mm_ + 0.5F;
  return columns_[static_cast<std::size_t>(std::clamp(place, 0.0F, static_cast<float>(columns_of_table - 1)))];
}

float LightSpread::across2(float x_p_mm, float u_mm, float columns_per_mm) const {
  const float held = static_cast<float>(hold_rad_) * u_mm * columns_per_mm;
  if (columns_.empty()) return held * held;
  const float opened = column(x_p_mm).across.at(u_mm) * columns_per_mm;
  return held * held + opened * opened;
}

float LightSpread::along_mm(float x_p_mm, float u_mm) const { return std::abs(column(x_p_mm).along.at(u_mm)); }

}  // namespace vam::light
