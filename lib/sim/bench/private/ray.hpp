// SPDX-License-Identifier: GPL-3.0-or-later
// A chief ray through the bath's window and the vial, in the plane across the axis, for simulated cameras and beams:
// unit vectors, and Snell's law in vector form at each surface. It shares nothing with lib/optics, which tests
// judge by this bench.
#pragma once

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

struct SimVector {
  double x;
  double y;  // along the light
};

/// Light on its way: a point, a unit direction, and what has passed so far.
struct SimLight {
  SimVector at;
  SimVector along;
  double transmittance = 1;

  void go(double far) { at = {at.x + far * along.x, at.y + far * along.y}; }
  /// Into index n2 from n1 through a surface here whose unit normal points against the light: the direction by Snell's
  /// law, the transmittance by Fresnel's equations, unpolarised. False: total reflection.
  [[nodiscard]] bool enter(double n1, double n2, SimVector normal) {
    const double cosine1 = -(along.x * normal.x + along.y * normal.y);
    const double eta = n1 / n2;
    const double square = 1 - eta * eta * (1 - cosine1 * cosine1);
    if (square <= 0) return false;
    const double cosine2 = std::sqrt(square);
    const double back = eta * cosine1 - cosine2;
    along = {eta * along.x + back * normal.x, eta * along.y + back * normal.y};
    const double amplitude_s = 2 * n1 * cosine1 / (n1 * cosine1 + n2 * cosine2);
    const double amplitude_p = 2 * n1 * cosine1 / (n2 * cosine1 + n1 * cosine2);
    const double flux = n2 * cosine2 / (n1 * cosine1);
    transmittance *= 0.5 * flux * (amplitude_s * amplitude_s + amplitude_p * amplitude_p);
    return true;
  }
};

/// The ray that would cross the plane of the axis at x_mm if all were air; distance_mm to the lens, none when
/// telecentric.
[[nodiscard]] inline SimRay sim_ray(double x_mm, std::optional<double> distance_mm, const SimShells& through) {
  const double length = distance_mm ? std::hypot(x_mm, *distance_mm) : 1;
  SimLight light{{x_mm, 0}, distance_mm ? SimVector{x_mm / length, *distance_mm / length} : SimVector{0, 1}};
  const SimRay beside{false, x_mm, 0, 0};
  light.go(-through.window_mm / light.along.y);
  if (!light.enter(1, through.outside, {0, -1})) return beside;
  double index = through.outside;
  for (const SimShell& shell : through.shells) {
    const double nearest = light.at.x * light.along.x + light.at.y * light.along.y;
    const double beyond = light.at.x * light.at.x + light.at.y * light.at.y - shell.radius_mm * shell.radius_mm;
    const double square = nearest * nearest - beyond;
    if (square <= 0) return beside;
    light.go(-nearest - std::sqrt(square));
    if (!light.enter(index, shell.index, {light.at.x / shell.radius_mm, light.at.y / shell.radius_mm})) return beside;
    index = shell.index;
  }
  return {true, light.at.x * light.along.y - light.at.y * light.along.x, std::atan2(-light.along.x, light.along.y),
          light.transmittance};
}

}  // namespace vam::sim
