// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/camera_views.hpp"

#include <cmath>
#include <numbers>

namespace vam::oracle {

Camera::Camera(const CameraBench& bench, double step_mm, double reach_mm) : bench_(bench), step_mm_(step_mm) {
  const double c = std::cos(bench.tilt_rad);
  const double s = std::sin(bench.tilt_rad);
  for (int row = 0; row < bench.rows; ++row) {
    for (int column = 0; column < bench.columns; ++column) {
      const double right = (column - bench.axis_column) * bench.pixel_mm;
      const double down = (row - 0.5 * (bench.rows - 1)) * bench.pixel_mm;
      // The camera is rolled about its line of sight, so that the axis leans in the image.
      const auto ray = trace(bench.bench, c * right - s * down, -(s * right + c * down));
      Sight sight;
      if (ray) {
        // Closest approach to the axis, then reach_mm to both sides.
        const Vec& p = ray->point;
        const Vec& d = ray->direction;
        const Real flat = d[0] * d[0] + d[1] * d[1];
        const Real along = -(p[0] * d[0] + p[1] * d[1]) / flat;
        const Real nearest2 = std::pow(p[0] + along * d[0], 2) + std::pow(p[1] + along * d[1], 2);
        const Real half2 = (static_cast<Real>(reach_mm) * reach_mm - nearest2) / flat;
        if (half2 > 0) {
          const Real begin = along - std::sqrt(half2);
          sight.seen = true;
          sight.steps = static_cast<int>(2 * std::sqrt(half2) / step_mm);
          for (int i = 0; i < 3; ++i) sight.start[i] = p[i] + begin * d[i];
          sight.direction = d;
          sight.weight = static_cast<double>(ray->transmittance) * step_mm;
        }
      }
      sights_.push_back(sight);
    }
  }
}

std::vector<float> Camera::view(const Density& density, double stage_deg) const {
  const double turn = (stage_deg + bench_.azimuth_deg) * std::numbers::pi / 180;
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  std::vector<float> pixels;
  pixels.reserve(sights_.size());
  for (const Sight& sight : sights_) {
    double sum = 0;
    for (int i = 0; sight.seen && i < sight.steps; ++i) {
      const double u = (i + 0.5) * step_mm_;
      const auto at = [&](int axis) {
        return static_cast<double>(sight.start[axis]) + u * static_cast<double>(sight.direction[axis]);
      };
      sum += density(c * at(0) - s * at(1), s * at(0) + c * at(1), at(2));
    }
    pixels.push_back(static_cast<float>(sum * sight.weight));
  }
  return pixels;
}

}  // namespace vam::oracle
