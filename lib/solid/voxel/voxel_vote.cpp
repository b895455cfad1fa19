// SPDX-License-Identifier: GPL-3.0-or-later
// Inside by the vote of three axes, for meshes with holes; see voxelize.hpp.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "solid/voxel/private/coverage.hpp"

namespace vam::solid {

namespace {

constexpr float undecided = std::numeric_limits<float>::quiet_NaN();

// What the pieces of one slice add up to along each axis.
struct SliceSums {
  VoxelRows x;                   // ny rows
  VoxelRows y;                   // nx rows
  std::vector<double> z_own;     // by column (i, j): the winding number of this slice's voxel
  std::vector<double> z_behind;  // what all pieces of this slice add to the slices above
};

std::size_t column(const model::Grid& grid, int i, int j) { return flat_index(j, grid.nx, i); }

// For every column along z the total of its pieces, which is 0 unless a hole lies above or below.
std::vector<double> column_totals(const std::vector<TriangleCorners>& triangles, const model::Grid& grid) {
  std::vector<double> totals(grid.slice_size(), 0.0);
  const Buckets<int> bins = by_layer(triangles, 1, grid.ny);
  parallel_for(grid.ny, [&](int j) {
    for (const int t : bins[j]) {
      const Polygon strip = layer(polygon(triangles[t]), 1, j, grid.ny);
      if (strip.count < 3) continue;
      for_each_layer(strip, 0, grid.nx,
                     [&](int i, const Polygon& piece) { totals[column(grid, i, j)] -= moment(piece, 2).area; });
    }
  });
  return totals;
}

void enter_slice(const std::vector<TriangleCorners>& triangles, std::span<const int> members, const model::Grid& grid,
                 int k, SliceSums& sums) {
  sums.x.reset(grid.ny, grid.nx);
  sums.y.reset(grid.nx, grid.ny);
  sums.z_own.assign(grid.slice_size(), 0.0);
  sums.z_behind.assign(grid.slice_size(), 0.0);
  for (const int t : members) {
    const Polygon slice = layer(polygon(triangles[t]), 2, k, grid.nz);
    if (slice.count < 3) continue;
    for_each_layer(slice, 1, grid.ny, [&](int j, const Polygon& strip) {
      for_each_layer(strip, 0, grid.nx, [&](int i, const Polygon& piece) {
        VoxelRows::enter(sums.x[j], i, moment(piece, 0));
        VoxelRows::enter(sums.y[i], j, moment(piece, 1));
        const Moment along_z = moment(piece, 2);
        sums.z_own[column(grid, i, j)] -= own_share(along_z, k);
        sums.z_behind[column(grid, i, j)] -= along_z.area;
      });
    });
  }
}

// The votes along one axis from its two ends: the sum from one end of the row, and that from the other.
struct Ends {
  float a;
  float b;
};
Ends ends(double sum, double total) { return {settled(sum), settled(sum - total)}; }

// Median of the six ends; undecided when the middle two are more than a half apart. An axis whose ends span 0...1 has
// no say; a single axis that misses a hole on either side is outvoted by the other two.
float median(Ends x, Ends y, Ends z) {
  std::array<float, 6> all{x.a, x.b, y.a, y.b, z.a, z.b};
  std::sort(all.begin(), all.end());
  if (all[3] - all[2] > 0.5F) return undecided;
  return 0.5F * (all[2] + all[3]);
}

void decide_slice(const model::Grid& grid, const std::vector<double>& z_totals, SliceSums& sums, float* out) {
  std::vector<double> y_totals(grid.nx, 0.0);
  for (int i = 0; i < grid.nx; ++i) {
    if (sums.y.touched(i)) y_totals[i] = sums.y.accumulate(i);
  }
  for (int j = 0; j < grid.ny; ++j) {
    const bool any_x = sums.x.touched(j);
    const double x_total = any_x ? sums.x.accumulate(j) : 0;
    const double* x_sums = any_x ? sums.x[j] : nullptr;
    for (int i = 0; i < grid.nx; ++i) {
      const std::size_t at = column(grid, i, j);
      const Ends x = any_x ? ends(x_sums[i], x_total) : Ends{0, 0};
      const Ends y = sums.y.touched(i) ? ends(sums.y[i][j], y_totals[i]) : Ends{0, 0};
      out[at] = median(x, y, ends(sums.z_own[at], z_totals[at]));
    }
  }
}

// Undecided voxels take the mean of their decided neighbours in the slice, from the rim inwards; without any, 0.
long settle_undecided(const model::Grid& grid, float* out) {
  std::vector<std::size_t> open;
  for (std::size_t at = 0; at < grid.slice_size(); ++at) {
    if (std::isnan(out[at])) open.push_back(at);
  }
  const auto count = static_cast<long>(open.size());
  const auto nx = static_cast<std::size_t>(grid.nx);
  while (!open.empty()) {
    std::vector<std::pair<std::size_t, float>> means;
    for (const std::size_t at : open) {
      float sum = 0;
      float decided = 0;
      const auto look = [&](bool exists, std::size_t neighbour) {
        if (!exists || std::isnan(out[neighbour])) return;
        sum += out[neighbour];
        ++decided;
      };
      look(at % nx > 0, at - 1);
      look(at % nx + 1 < nx, at + 1);
      look(at >= nx, at - nx);
      look(at + nx < grid.slice_size(), at + nx);
      if (decided > 0) means.emplace_back(at, sum / decided);
    }
    for (const auto& [at, mean] : means) out[at] = mean;
    if (means.empty())
      for (const std::size_t at : open) out[at] = 0;
    std::erase_if(open, [&](std::size_t at) { return !std::isnan(out[at]); });
  }
  return count;
}

}  // namespace

Vote vote(const std::vector<TriangleCorners>& triangles, const model::Grid& grid, const SliceSink& sink) {
  const std::vector<double> z_totals = column_totals(triangles, grid);
  const Buckets<int> bins = by_layer(triangles, 2, grid.nz);
  std::vector<SliceSums> sums(slab);
  std::vector<double> below(grid.slice_size(), 0.0);  // winding numbers that the slices below hand up
  std::vector<float> slices(grid.slice_size() * slab);
  std::array<Vote, slab> votes;
  Vote all;
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const int count = std::min(slab, grid.nz - k0);
    parallel_for(count, [&](int s) { enter_slice(triangles, bins[k0 + s], grid, k0 + s, sums[s]); });
    parallel_for(grid.ny, [&](int j) {
      for (std::size_t at = column(grid, 0, j); at < column(grid, 0, j + 1); ++at) {
        for (int s = 0; s < count; ++s) {
          SliceSums& slice = sums[s];
          slice.z_own[at] += below[at];
          below[at] += slice.z_behind[at];
        }
      }
    });
    parallel_for(count, [&](int s) {
      float* out = slices.data() + product(s, grid.slice_size());
      decide_slice(grid, z_totals, sums[s], out);
      const long open = settle_undecided(grid, out);
      votes[s] = {std::count_if(out, out + grid.slice_size(), [](float c) { return c > 0.5F; }), open};
    });
    for (int s = 0; s < count; ++s) {
      all.inside += votes[s].inside;
      all.undecided += votes[s].undecided;
    }
    sink(k0, count, slices.data());
  }
  return all;
}

}  // namespace vam::solid
