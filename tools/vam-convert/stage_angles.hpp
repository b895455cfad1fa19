// SPDX-License-Identifier: GPL-3.0-or-later
// Measured stage angles as even steps.
#pragma once

#include <string>
#include <vector>

namespace vam::convert_tool {

/// What is stated about the angles of projections, as measured; none where `source` is empty.
struct StatedViews {
  std::string source;  // frames.csv, or the key of a video
  std::vector<double> angles_deg;
};

struct StageAngles {
  double start_deg = 0;
  double step_deg = 0;  // negative for a stage that turns the other way; 0: a single projection does not show it
};

/// The steps, of which a whole number makes a turn. Each angle is within a tenth of a step of its place, which moves
/// nothing in the vial by more than some tenth of a column where there are as many projections as those resolve. Notes
/// what it found. Throws Fault::data that begins with `name`: uneven steps, with the first that differs; another number
/// of angles than projections.
[[nodiscard]] StageAngles even_angles(const StatedViews& views, int projections, const std::string& name);

}  // namespace vam::convert_tool
