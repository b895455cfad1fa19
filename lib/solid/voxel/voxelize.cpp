// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/voxelize.hpp"

#include <algorithm>
#include <vector>

#include "base/parallel.hpp"
#include "solid/voxel/private/coverage.hpp"
#include "solid/voxel/private/voxel_vote.hpp"

namespace vam::solid {

namespace {

void slice_exact(const std::vector<TriangleCorners>& triangles, std::span<const int> members, const model::Grid& grid,
                 int k, VoxelRows& rows, float* out) {
  rows.reset(grid.ny, grid.nx);
  for (const int t : members) {
    const Polygon slice = layer(polygon(triangles[t]), 2, k, grid.nz);
    if (slice.count < 3) continue;
    for_each_layer(slice, 1, grid.ny, [&](int j, const Polygon& strip) {
      double* row = rows[j];
      for_each_layer(strip, 0, grid.nx,
                     [&](int i, const Polygon& piece) { VoxelRows::enter(row, i, moment(piece, 0)); });
    });
  }
  for (int j = 0; j < grid.ny; ++j) {
    float* line = out + static_cast<std::ptrdiff_t>(j) * grid.nx;
    if (!rows.touched(j)) {
      std::fill(line, line + grid.nx, 0.0F);
      continue;
    }
    const double* row = rows[j];
    double sum = 0;
    for (int i = 0; i < grid.nx; ++i) line[i] = settled(sum += row[i]);
  }
}

}  // namespace

Vote voxelize(const model::TriangleSoup& mesh, const model::Grid& grid, Fill fill, const SliceSink& sink) {
  const std::vector<TriangleCorners> triangles = in_voxels(mesh, grid);
  if (fill == Fill::vote) return vote(triangles, grid, sink);
  const Bins bins(triangles, 2, grid.nz);
  std::vector<VoxelRows> rows(slab);
  std::vector<float> slices(grid.slice_size() * slab);
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const int count = std::min(slab, grid.nz - k0);
    parallel_for(count, [&](int s) {
      float* out = slices.data() + static_cast<std::size_t>(s) * grid.slice_size();
      slice_exact(triangles, bins[k0 + s], grid, k0 + s, rows[s], out);
    });
    sink(k0, count, slices.data());
  }
  return {};
}

}  // namespace vam::solid
