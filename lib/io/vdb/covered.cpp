// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/covered.hpp"

#include "io/vdb/private/grid.hpp"

namespace vam::io {

model::VoxelBox covered_box(const SparseVolume& volume, float above) {
  const SparseVolume::State& state = volume.state();
  openvdb::CoordBBox all;
  for (auto tile = state.sparse->cbeginValueAll(); tile; ++tile) {
    if (!tile.isVoxelValue() && *tile > above) all.expand(tile.getBoundingBox());
  }
  LeafStore::Values room;
  for (auto leaf = state.sparse->tree().cbeginLeaf(); leaf; ++leaf) {
    if (all.isInside(leaf->getNodeBoundingBox())) continue;
    const float* values = state.leaves->values(*leaf, room);
    for (openvdb::Index n = 0; n < LeafStore::Leaf::SIZE; ++n) {
      if (values[n] > above) all.expand(leaf->offsetToGlobalCoord(n));
    }
  }
  if (all.empty()) return {};
  const openvdb::Coord low = all.min() - state.first;
  const openvdb::Coord high = all.max() - state.first;
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

}  // namespace vam::io
