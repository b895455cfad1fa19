// A chief ray through the bath's window and the vial, in the plane across the axis, for simulated cameras: Snell at
// the window, then Bouguer's n b [physics §2].
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "model/printer.hpp"

namespace vam::sim {

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
  double outside = 1;            // air, or the bath behind its window
  double window_mm = 0;          // from the axis; counts only with a bath
  std::vector<SimShell> shells;  // from outside to inside; the last is the resin
};

[[nodiscard]] inline SimShells outer_shells(const model::Printer& printer, double resin_index) {
  SimShells all{printer.bath.index, printer.bath.index == 1 ? 0 : printer.bath.window_mm, {}};
  if (printer.vial.wall_mm > 0) all.shells.push_back({printer.vial.radius_mm, printer.vial.index_glass});
  all.shells.push_back({model::resin_radius_mm(printer.vial), resin_index});
  return all;
}

/// Transmittance of unpolarised intensity from index n1 to n2, with the cosines of the angles there (Fresnel).
[[nodiscard]] inline double sim_passed(double n1, double cos1, double n2, double cos2) {
  const double across = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
  const double along = (n2 * cos1 - n1 * cos2) / (n2 * cos1 + n1 * cos2);
  return 1 - 0.5 * (across * across + along * along);
}

/// The ray that would cross the plane of the axis at x_mm if all were air; distance_mm to the lens, none when
/// telecentric.
[[nodiscard]] inline SimRay sim_ray(double x_mm, std::optional<double> distance_mm, const SimShells& through) {
  const double in_air = distance_mm ? std::atan(x_mm / *distance_mm) : 0;
  const double lean = std::asin(std::sin(in_air) / through.outside);
  const double crossing_mm = x_mm + through.window_mm * (std::tan(lean) - std::tan(in_air));
  const double invariant = through.outside * crossing_mm * std::cos(lean);  // n b
  SimRay ray{true, x_mm, -lean, sim_passed(1, std::cos(in_air), through.outside, std::cos(lean))};
  double index = through.outside;
  for (const SimShell& shell : through.shells) {
    const double before = invariant / (index * shell.radius_mm);
    const double after = invariant / (shell.index * shell.radius_mm);
    if (std::abs(before) >= 1 || std::abs(after) >= 1) return {false, x_mm, 0, 0};
    ray.turn_rad += std::asin(before) - std::asin(after);
    ray.transmittance *= sim_passed(index, std::sqrt(1 - before * before), shell.index, std::sqrt(1 - after * after));
    index = shell.index;
  }
  ray.offset_mm = invariant / index;
  return ray;
}

}  // namespace vam::sim
