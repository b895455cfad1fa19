// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/sight_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/constants.hpp"
#include "model/absorption.hpp"
#include "model/circle.hpp"

namespace vam::metrology {

namespace {
constexpr int columns = 1200;
}

SightLines::SightLines(const model::Printer& printer)
    : absorption_per_mm_(printer.resin.absorption_per_mm), seen_absorption_per_mm_(printer.camera.absorption_per_mm) {
  const optics::View view = optics::camera_view(printer);
  radius_mm_ = optics::resin_radius_mm(view);
  const double azimuth = printer.camera.azimuth_deg * rad_per_deg;
  const double edge_mm = optics::edge_column(view).x_p_mm;
  const auto column_mm = [&](double i) { return -edge_mm * std::cos(std::numbers::pi * i / columns); };
  for (int i = 0; i <= columns; ++i) {  // denser towards the edges, where they turn fast
    const auto ray = optics::chief_ray(view, column_mm(i));
    const double part = (column_mm(i + 1) - column_mm(i)) / (2 * radius_mm_);
    const double turn = ray.delta_rad + azimuth;
    const double passed = optics::chief_ray(view, column_mm(i + 0.5)).transmittance;
    sights_.push_back(
        {ray.x_v_mm, std::cos(turn), std::sin(turn), model::half_chord(radius_mm_, ray.x_v_mm), part * passed});
  }
}

double SightLines::seen(const optics::ChiefRay& ray) const {
  if (!ray.hits) return 0;
  const double half_mm = model::half_chord(radius_mm_, ray.x_v_mm);
  const double cosine = std::cos(ray.delta_rad);
  const double sine = std::sin(ray.delta_rad);
  const auto across = [&](const Sight& sight) { return sight.sine * cosine - sight.cosine * sine; };
  const auto along = [&](const Sight& sight) { return sight.cosine * cosine + sight.sine * sine; };
  const auto crossing_mm = [&](const Sight& sight) {  // u of the sheet, along the light [physics §10]
    return (sight.offset_mm - ray.x_v_mm * along(sight)) / across(sight);
  };
  const auto left = [&](const Sight& sight, double u_mm) {  // of the light at u, in the camera
    const double back_mm = sight.chord_mm - ray.x_v_mm * across(sight) + u_mm * along(sight);
    return model::transmitted(absorption_per_mm_, half_mm + u_mm) *
           model::transmitted(seen_absorption_per_mm_, std::max(0.0, back_mm));
  };
  double sum = 0;
  double after_mm = crossing_mm(sights_.front());
  for (std::size_t i = 0; i + 1 < sights_.size(); ++i) {
    const double before_mm = std::exchange(after_mm, crossing_mm(sights_[i + 1]));
    const auto [first_mm, last_mm] = std::minmax(before_mm, after_mm);
    const double from_mm = std::max(first_mm, -half_mm);
    const double to_mm = std::min(last_mm, half_mm);
    const double slant = across(sights_[i]);
    const double next_slant = across(sights_[i + 1]);
    if (!(to_mm > from_mm) || slant * next_slant <= 0) continue;
    // The sheet carries its light however slanted it is crossed.
    sum += sights_[i].weight * (to_mm - from_mm) / (last_mm - first_mm) / (0.5 * std::abs(slant + next_slant)) *
           left(sights_[i], 0.5 * (from_mm + to_mm));
  }
  return ray.transmittance * sum;
}

}  // namespace vam::metrology
