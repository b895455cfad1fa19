// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a simulated print.
#pragma once

#include <string>
#include <vector>

namespace vam::sim {

/// A body of the print in the part's frame (mm): a sphere, or an upright cylinder of that height.
struct SimBody {
  double x_mm = 0, y_mm = 0, z_mm = 0;
  double radius_mm = 2;
  double height_mm = 0;  // 0: a sphere
};

/// "sphere:x=2,diameter=4;cylinder:diameter=6,height=3"; keys x, y, z, diameter, height. Throws Fault::usage.
[[nodiscard]] std::vector<SimBody> parse_bodies(const std::string& text);

/// Path through the body, swollen by `growth`, of a level ray at height z_mm that passes its axis at distance_mm.
[[nodiscard]] double chord_mm(const SimBody& body, double growth, double z_mm, double distance_mm);

}  // namespace vam::sim
