// A chief ray through the vial in the plane across the axis, for simulated cameras (physics: Bouguer's n b).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "model/printer.hpp"

namespace vam::device {

/// Inside the resin the ray is { offset (cos turn, sin turn) + u (-sin turn, cos turn) }, u along the light.
struct SimRay {
  bool enters = false;  // false: it passes beside the resin; offset_mm then only has a sign
  double offset_mm = 0;
  double turn_rad = 0;
  double transmittance = 0;  // of all interfaces, unpolarised
};

struct SimShell {
  double radius_mm;
  double index;  // inside
};
struct SimShells {
  double outside = 1;
  std::vector<SimShell> shells;  // from outside to inside; the last is the resin
};

[[nodiscard]] inline SimShells outer_shells(const model::Printer& printer, double resin_index) {
  SimShells all{printer.bath.index, {}};
  if (printer.vial.wall_mm > 0) all.shells.push_back({printer.vial.radius_mm, printer.vial.index_glass});
  all.shells.push_back({model::resin_radius_mm(printer.vial), resin_index});
  return all;
}

/// The ray that crosses the plane of the axis at x_mm; distance_mm to the lens, none when telecentric.
[[nodiscard]] inline SimRay sim_ray(double x_mm, std::optional<double> distance_mm, const SimShells& through) {
  const double lean = distance_mm ? std::atan(x_mm / *distance_mm) : 0;
  const double invariant = through.outside * x_mm * std::cos(lean);  // n b
  SimRay ray{true, x_mm, -lean, 1};
  double index = through.outside;
  for (const SimShell& shell : through.shells) {
    const double before = invariant / (index * shell.radius_mm);
    const double after = invariant / (shell.index * shell.radius_mm);
    if (std::abs(before) >= 1 || std::abs(after) >= 1) return {false, x_mm, 0, 0};
    ray.turn_rad += std::asin(before) - std::asin(after);
    const double c0 = std::sqrt(1 - before * before);
    const double c1 = std::sqrt(1 - after * after);
    const double across = (index * c0 - shell.index * c1) / (index * c0 + shell.index * c1);
    const double along = (shell.index * c0 - index * c1) / (shell.index * c0 + index * c1);
    ray.transmittance *= 1 - 0.5 * (across * across + along * along);
    index = shell.index;
  }
  ray.offset_mm = invariant / index;
  return ray;
}

}  // namespace vam::device
