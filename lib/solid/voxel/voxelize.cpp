// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/voxelize.hpp"

#include <algorithm>
#include <vector>

#include "base/compute/parallel.hpp"
#include "solid/voxel/private/coverage.hpp"
#include "solid/voxel/private/union_row.hpp"
#include "solid/voxel/private/voxel_vote.hpp"

namespace vam::solid {

namespace {

// Rows and slices of the grid in which solids may overlap.
struct SharedRows {
  Span y{0, -1};
  Span z{0, -1};

  SharedRows(const Bounds& shared, const model::Grid& grid) {
    const auto span = [&](std::size_t axis, int size) {
      const auto in_voxels = [&](double mm) { return (mm - grid.origin_mm[axis]) / grid.voxel_mm + 0.5; };
      return span_of(in_voxels(shared.low[axis]), in_voxels(shared.high[axis]), size);
    };
    if (shared.low[0] > shared.high[0]) return;
    y = span(1, grid.ny);
    z = span(2, grid.nz);
  }
  [[nodiscard]] bool has(int j, int k) const { return j >= y.first && j <= y.last && k >= z.first && k <= z.last; }
};

// Rows in which solids overlap, by the triangles of the slice that meet them.
void unite_rows(const std::vector<TriangleCorners>& triangles, std::span<const int> members, const model::Grid& grid,
                int k, const std::vector<char>& doubtful, float* out) {
  std::vector<std::vector<Polygon>> strips(doubtful.size());
  for (const int t : members) {
    const Polygon slice = layer(polygon(triangles[t]), 2, k, grid.nz);
    if (slice.count < 3) continue;
    for_each_layer(slice, 1, grid.ny, [&](int j, const Polygon& strip) {
      if (doubtful[j] != 0) strips[j].push_back(strip);
    });
  }
  for (int j = 0; j < grid.ny; ++j) {
    if (doubtful[j] != 0) unite_row(strips[j], j, k, grid.nx, out + static_cast<std::ptrdiff_t>(j) * grid.nx);
  }
}

void slice_exact(const std::vector<TriangleCorners>& triangles, std::span<const int> members, const model::Grid& grid,
                 const SharedRows& shared, int k, VoxelRows& rows, float* out) {
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
  std::vector<char> doubtful(grid.ny, 0);
  for (int j = 0; j < grid.ny; ++j) {
    float* line = out + static_cast<std::ptrdiff_t>(j) * grid.nx;
    if (!rows.touched(j)) {
      std::fill(line, line + grid.nx, 0.0F);
      continue;
    }
    const double* row = rows[j];
    double sum = 0;
    double most = 0;
    for (int i = 0; i < grid.nx; ++i) {
      line[i] = settled(sum += row[i]);
      most = std::max(most, sum);
    }
    constexpr double rounding = 1e-6;
    doubtful[j] = most > 1 + rounding || shared.has(j, k) ? 1 : 0;
  }
  if (std::find(doubtful.begin(), doubtful.end(), 1) != doubtful.end()) {
    unite_rows(triangles, members, grid, k, doubtful, out);
  }
}

}  // namespace

Vote voxelize(const model::TriangleSoup& mesh, const model::Grid& grid, Fill fill, const Bounds& shared,
              const SliceSink& sink) {
  const std::vector<TriangleCorners> triangles = in_voxels(mesh, grid);
  if (fill == Fill::vote) return vote(triangles, grid, sink);
  const Bins bins(triangles, 2, grid.nz);
  const SharedRows shared_rows(shared, grid);
  std::vector<VoxelRows> rows(slab);
  std::vector<float> slices(grid.slice_size() * slab);
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const int count = std::min(slab, grid.nz - k0);
    parallel_for(count, [&](int s) {
      float* out = slices.data() + static_cast<std::size_t>(s) * grid.slice_size();
      slice_exact(triangles, bins[k0 + s], grid, shared_rows, k0 + s, rows[s], out);
    });
    sink(k0, count, slices.data());
  }
  return {};
}

}  // namespace vam::solid
