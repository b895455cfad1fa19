// Inside by the vote of three axes, for meshes with holes; see voxelize.hpp.
#pragma once

#include "solid/voxel/private/voxel_mesh.hpp"
#include "solid/voxel/voxelize.hpp"

namespace vam::solid {

Vote vote(const std::vector<Corners>& triangles, const model::Grid& grid, const SliceSink& sink);

}  // namespace vam::solid
