// SPDX-License-Identifier: GPL-3.0-or-later
// A print in short: few iterations on coarse voxels, and what becomes of them in a printer off its settings.
#pragma once

#include <utility>
#include <vector>

#include "model/grid.hpp"
#include "model/printer.hpp"
#include "model/tolerances.hpp"
#include "optimize/run/shown.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/run/yield.hpp"

namespace vam::optimize {

struct PreviewTask {
  model::Volume target;    // coverage, on the voxels of the preview
  model::Printer printer;  // with pixels as large (model::coarser)
  double radius_mm = 0;    // of the resin that is constrained (optics::judged_radius_mm)
  model::VoxelBox part;    // its box in the target
  int angles = 92;         // a multiple of 4: quarters of a turn share their rays
  int print_angles = 360;  // of the print, while one of whose frames is shown the stage turns by stage.motion
  int iterations = 12;     // and more, up to 60 in seconds, while it does not print with the margin of --method auto
  model::Tolerances tolerances{};
  Expose expose;
};

struct Preview {
  model::Grid grid;  // all that the light reaches: the voxels of the outcome
  VolumeOutcome outcome;
  /// If the resin set at a dose that is lower and higher by verdict::dose_margin, by which the dose differs from that
  /// of more iterations on voxels as large.
  std::vector<VolumeOutcome> beside;
  Trials trials;
  /// Process windows of the same light in frames of prints of so many angles, each of which is shown while the stage
  /// turns to the next; empty where it stands.
  std::vector<std::pair<int, double>> by_angles;
};

/// Optimises by --method auto. Throws as optimise() and run_trials() do.
[[nodiscard]] Preview preview(const PreviewTask& task);

}  // namespace vam::optimize
