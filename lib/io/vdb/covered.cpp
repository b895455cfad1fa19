// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "io/vdb/private/leaf_store.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

/// Calls take(box) for all voxels whose value is above that, box by box, but for leaves of which skip(box) is true.
template <class Skip, class Take>
void for_above(const SparseVolume& volume, float above, const Skip& skip, const Take& take) {
  const SparseVolume::State& state = volume.state();
  const auto moved = [&](const openvdb::CoordBBox& box) {
    return openvdb::CoordBBox(box.min() - state.first, box.max() - state.first);
  };
  auto tile = state.sparse->constTree().cbeginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::DEPTH - 2);  // above the leaves
  for (; tile; ++tile) {
    if (*tile > above) take(moved(tile.getBoundingBox()));
  }
  LeafStore::Values room;
  for (auto leaf = state.sparse->constTree().cbeginLeaf(); leaf; ++leaf) {
    if (skip(moved(leaf->getNodeBoundingBox()))) continue;
    const float* values = state.leaves->values(*leaf, room);
    for (openvdb::Index n = 0; n < LeafStore::Leaf::SIZE; ++n) {
      const openvdb::Coord at = leaf->offsetToGlobalCoord(n) - state.first;
      if (values[n] > above) take(openvdb::CoordBBox(at, at));
    }
  }
}

}  // namespace

model::VoxelBox covered_box(const SparseVolume& volume, float above) {
  openvdb::CoordBBox all;
  for_above(
      volume, above, [&](const openvdb::CoordBBox& box) { return all.isInside(box); },
      [&](const openvdb::CoordBBox& box) { all.expand(box); });
  if (all.empty()) return {};
  return {{all.min().x(), all.min().y(), all.min().z()}, {all.max().x(), all.max().y(), all.max().z()}};
}

double farthest_mm(const SparseVolume& volume, float above) {
  const model::Grid& grid = volume.grid();
  const auto far = [](double a, double b) { return std::max(std::abs(a), std::abs(b)); };
  const auto reach = [&](const openvdb::CoordBBox& box) {
    return std::hypot(far(grid.x_mm(box.min().x()), grid.x_mm(box.max().x())),
                      far(grid.y_mm(box.min().y()), grid.y_mm(box.max().y())));
  };
  double farthest = -1;
  for_above(
      volume, above, [&](const openvdb::CoordBBox& box) { return reach(box) <= farthest; },
      [&](const openvdb::CoordBBox& box) { farthest = std::max(farthest, reach(box)); });
  return farthest;
}

}  // namespace vam::io
