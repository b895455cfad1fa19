// SPDX-License-Identifier: GPL-3.0-or-later
// Over which stage angles each projection is shown: from edges_deg[n] to edges_deg[n + 1], not wrapped.
#pragma once

#include <string>
#include <vector>

namespace vam::convert_tool {

/// What is stated about projections: nothing where all are empty.
struct StatedViews {
  std::string source = {};              // of the angles: frames.csv, or the key of a video
  std::vector<double> angles_deg = {};  // at the middle of each
  std::vector<double> times_s = {};     // of a video: at the beginning of each, and at the end
};

/// Those of even steps, with projection n in the middle of its step at n step_deg.
[[nodiscard]] std::vector<double> even_edges_deg(int projections, double step_deg);

/// Those of a video that plays while the stage turns, negative for one that turns the other way; as those of even steps
/// where it has even times. Throws Fault::usage where `views` has no times.
[[nodiscard]] std::vector<double> timed_edges_deg(const StatedViews& views, double speed_deg_s,
                                                  const std::string& name);

/// Those of stated angles, each shown until half way to the next, the shorter way. Throws Fault::data that begins with
/// `name` for another number of angles than projections, and for what is no angle.
[[nodiscard]] std::vector<double> stated_edges_deg(const StatedViews& views, int projections, const std::string& name);

}  // namespace vam::convert_tool
