// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/lit_fraction.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <numbers>

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
void light_between(const ChiefRay& a, const ChiefRay& b, double radius_mm, Directions& lit) {
  if (std::min(std::abs(a.x_v_mm), std::abs(b.x_v_mm)) > radius_mm) return;
  const auto half_angle = [&](const ChiefRay& ray) { return std::acos(std::clamp(ray.x_v_mm / radius_mm, -1.0, 1.0)); };
  for (const double side : {1.0, -1.0}) {
    lit.light(a.delta_rad + side * half_angle(a), b.delta_rad + side * half_angle(b));
  }
}

}  // namespace

double lit_fraction(const model::Printer& printer, double radius_mm) {
  constexpr int samples = 20000;
  const model::Projector& projector = printer.projector;
  const View view = projector_view(printer);
  const double left_mm = (-0.5 - projector.axis_column) * projector.pixel_mm;
  const double width_mm = projector.columns * projector.pixel_mm;
  Directions lit;
  ChiefRay last;
  for (int i = 0; i <= samples; ++i) {
    const ChiefRay ray = chief_ray(view, left_mm + width_mm * i / samples);
    if (ray.hits && last.hits) light_between(last, ray, radius_mm, lit);
    last = ray;
  }
  return lit.fraction();
}

}  // namespace vam::optics
