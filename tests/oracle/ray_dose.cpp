// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/ray_dose.hpp"

#include <cmath>
#include <numbers>

namespace vam::oracle {

double ray_dose(const RayDose& setup, const std::function<double(double, double)>& intensity, double x, double y,
                double radius) {
  const double pi = std::numbers::pi;
  const double resin = static_cast<double>(setup.bench.cylinders.back().radius);
  const double dx = 2 * setup.half_field / setup.rays;
  const double step = 2 * pi / setup.angles;
  double dose = 0;
  for (int k = 0; k < setup.rays; ++k) {
    const double x_p = -setup.half_field + (k + 0.5) * dx;
    const auto ray = trace(setup.bench, x_p);
    if (!ray) continue;
    const Line line = line_of(*ray);
    const double t = static_cast<double>(line.t);
    for (int a = 0; a < setup.angles; ++a) {
      const double around = a * step + static_cast<double>(line.a);  // the vial's turn adds to the line's angle
      const double away = x * std::cos(around) + y * std::sin(around) - t;
      if (std::abs(away) >= radius) continue;
      const double u = -x * std::sin(around) + y * std::cos(around);
      const double chord = 2 * std::sqrt(radius * radius - away * away);
      const double path = std::sqrt(resin * resin - t * t) + u;
      dose += intensity(x_p, a * step) * static_cast<double>(ray->transmittance) * dx * chord *
              std::exp(-setup.absorption * path);
    }
  }
  return dose * step / (pi * radius * radius);
}

}  // namespace vam::oracle
