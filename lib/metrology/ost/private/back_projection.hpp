// SPDX-License-Identifier: GPL-3.0-or-later
// Back-projection along rays that climb [FDK84; physics §8].
#pragma once

#include <vector>

#include "base/compute/slab.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// The rays of a virtual detector: the ray of column t and height zeta runs at zeta (1 + rate[t] u), u mm along the
/// light from the point nearest to the axis. Columns are as wide as a voxel, the axis in their middle.
struct ClimbingRays {
  int columns = 0;
  int angles = 0;                   // over a full turn from 0
  std::vector<double> rate_per_mm;  // of each column
  double gain_per_mm = 0;           // weight e^{gain u} of a point
  double scale = 1;                 // of every value
};

/// How many heights beyond a slice its rays reach, for the slices of the grid.
[[nodiscard]] int heights_beyond(const ClimbingRays& rays, const model::Grid& grid);

/// Fills slices [first, first + count) of the volume within the circle that the columns see. `filtered` has
/// columns x angles, heights from slice first - beyond on, 16 a slab, at the pitch of the slices.
void back_project(const ClimbingRays& rays, const std::vector<Slab>& filtered, int beyond, int first, int count,
                  model::Volume& volume);

}  // namespace vam::metrology
