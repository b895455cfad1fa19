// SPDX-License-Identifier: GPL-3.0-or-later
// What of a target in a file its voxels are too coarse for.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "base/index.hpp"
#include "facts.hpp"
#include "io/vdb/vdb.hpp"
#include "verdict/unresolved.hpp"

namespace vam::tool {

/// Of the part's surface, where the target states it.
inline std::optional<model::VoxelisedSurface> own_surface(const io::SparseVolume& target) {
  const auto places = stated_surface(target.metadata);
  if (!places) return std::nullopt;
  return model::VoxelisedSurface{*places, target.grid().voxel_mm};
}

inline verdict::Unresolved unresolved(const io::SparseVolume& target) {
  constexpr std::size_t million = 1'000'000;  // voxels at a time
  const model::Grid& grid = target.grid();
  const int slab = static_cast<int>(std::clamp<std::size_t>(million / grid.slice_size(), 1, 16));
  verdict::UnresolvedFinder finder(grid);
  std::vector<float> slices(product(slab, grid.slice_size()));
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    target.read_slices(k, count, slices.data());
    finder.add(count, slices.data());
  }
  verdict::Unresolved found = finder.found();
  found.surface = own_surface(target);
  return found;
}

}  // namespace vam::tool
