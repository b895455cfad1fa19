// SPDX-License-Identifier: GPL-3.0-or-later
// Signed distances to a surface on a grid, where they matter.
#pragma once

#include "model/grid.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::solid {

/// Signed distances in mm at the voxels of the grid, positive outside, cut off at +-band_mm; x fastest, then y, then z.
/// Blocks of voxels that lie farther away are not searched voxel by voxel.
[[nodiscard]] model::Volume distance_band(const Surface& surface, const model::Grid& grid, double band_mm);

}  // namespace vam::solid
