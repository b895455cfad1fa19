// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "io/vdb/private/grid.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

/// Distance from the axis to the farthest voxel centre of a box of voxels.
double farthest_corner(const model::Grid& grid, const openvdb::CoordBBox& box) {
  const auto far = [](double a, double b) { return std::max(std::abs(a), std::abs(b)); };
  return std::hypot(far(grid.x_mm(box.min().x()), grid.x_mm(box.max().x())),
                    far(grid.y_mm(box.min().y()), grid.y_mm(box.max().y())));
}

}  // namespace

double farthest_mm(const SparseVolume& volume, float above) {
  const SparseVolume::State& state = volume.state();
  double farthest = -1;
  const auto reach = [&](const openvdb::CoordBBox& box) {
    return farthest_corner(state.grid, {box.min() - state.first, box.max() - state.first});
  };
  for (auto tile = state.sparse->cbeginValueAll(); tile; ++tile) {
    if (tile.isVoxelValue()) continue;  // by leaves
    if (*tile > above) farthest = std::max(farthest, reach(tile.getBoundingBox()));
  }
  LeafStore::Values room;
  for (auto leaf = state.sparse->tree().cbeginLeaf(); leaf; ++leaf) {
    if (reach(leaf->getNodeBoundingBox()) <= farthest) continue;
    const float* values = state.leaves->values(*leaf, room);
    for (openvdb::Index n = 0; n < LeafStore::Leaf::SIZE; ++n) {
      const openvdb::Coord at = leaf->offsetToGlobalCoord(n);
      if (values[n] > above) farthest = std::max(farthest, reach({at, at}));
    }
  }
  return farthest;
}

}  // namespace vam::io
