// SPDX-License-Identifier: GPL-3.0-or-later
// Inside by the vote of three axes, for meshes with holes; see voxelize.hpp.
#pragma once

#include "solid/voxel/private/coverage.hpp"
#include "solid/voxel/voxelize.hpp"

namespace vam::solid {

/// Coverage 0 ... 1 of the voxels of `grid`, each triangle's corners in voxels from the grid's corner and in any
/// orientation that the mesh has consistently; slices go to the sink in ascending order. Returns how many voxels are
/// inside and about how many the axes disagree (Fill::vote). Throws Fault::bug when a corner lies outside in x or y.
Vote vote(const std::vector<TriangleCorners>& triangles, const model::Grid& grid, const SliceSink& sink);

}  // namespace vam::solid
