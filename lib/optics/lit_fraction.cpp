// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/lit_fraction.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "optics/chief_ray.hpp"

namespace vam::optics {

namespace {

/// Which directions of a turn are lit, to 0.05 degrees.
class Directions {
 public:
  void light(double from_rad, double to_rad) {
    const auto [first, last] = std::minmax({place(from_rad), place(to_rad)});
    for (int i = first; i <= last; ++i) lit_[(i % count + count) % count] = true;
  }
  [[nodiscard]] double fraction() const { return static_cast<double>(lit_.count()) / count; }

 private:
  static constexpr int count = 7200;
  static int place(double rad) { return floor_int(rad / (2 * std::numbers::pi) * count); }
  std::bitset<count> lit_;
};

// [physics §4]: a ray of offset t passes the circle of that radius at delta + acos(t / radius) and delta - acos(t /
// radius) in the lab; a turn carries every point of the circle past all directions. Rays between two light the arcs
// between theirs.
double fraction_at(const std::vector<ChiefRay>& rays, double distance_mm) {
  constexpr double nearest_mm = 0.01;  // some rays of the fan pass nearer to the axis
  const double radius_mm = std::max(distance_mm, nearest_mm);
  Directions lit;
  double last_half_angle = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const ChiefRay& ray = rays[i];
    if (!ray.hits) continue;
    const double half_angle = std::acos(std::clamp(ray.x_v_mm / radius_mm, -1.0, 1.0));
    if (i > 0 && rays[i - 1].hits && std::min(std::abs(rays[i - 1].x_v_mm), std::abs(ray.x_v_mm)) <= radius_mm) {
      for (const double side : {1.0, -1.0}) {
        lit.light(rays[i - 1].delta_rad + side * last_half_angle, ray.delta_rad + side * half_angle);
      }
    }
    last_half_angle = half_angle;
  }
  return lit.fraction();
}

std::vector<ChiefRay> fan(const model::Printer& printer) {
  constexpr int samples = 20000;
  const model::Projector& projector = printer.projector;
  const View view = projector_view(printer);
  const double left_mm = (-0.5 - projector.axis_column) * projector.pixel_mm;
  const double width_mm = projector.columns * projector.pixel_mm;
  std::vector<ChiefRay> rays;
  for (int i = 0; i <= samples; ++i) rays.push_back(chief_ray(view, left_mm + width_mm * i / samples));
  return rays;
}

}  // namespace

std::vector<double> lit_fractions(const model::Printer& printer, const std::vector<double>& radii_mm) {
  const std::vector<ChiefRay> rays = fan(printer);
  std::vector<double> fractions(radii_mm.size());
  parallel_for(count_of(radii_mm), [&](int i) { fractions[i] = fraction_at(rays, radii_mm[i]); });
  return fractions;
}

double lit_fraction(const model::Printer& printer, double radius_mm) {
  return lit_fractions(printer, {radius_mm}).front();
}

}  // namespace vam::optics
