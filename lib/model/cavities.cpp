// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/cavities.hpp"

#include <utility>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::model {

namespace {

constexpr std::int64_t least_voxels = 8;

/// Of a slice with its margin; null: one of the margin alone.
std::vector<VoxelRun> free_runs(const Grid& grid, const float* slice) {
  std::vector<VoxelRun> runs;
  for (int y = 0; y < grid.ny + 2; ++y) {
    const bool margin = slice == nullptr || y == 0 || y == grid.ny + 1;
    const float* row = margin ? nullptr : slice + product(y - 1, grid.nx);
    int begin = 0;
    for (int x = 1; row != nullptr && x <= grid.nx; ++x) {
      if (!half_covered(row[x - 1])) continue;
      if (begin < x) runs.push_back({y, begin, x});
      begin = x + 1;
    }
    runs.push_back({y, begin, grid.nx + 2});
  }
  return runs;
}

}  // namespace

CavityFinder::CavityFinder(const Grid& grid) : grid_(grid) { add(free_runs(grid_, nullptr)); }

void CavityFinder::add(int count, const float* slices) {
  std::vector<std::vector<VoxelRun>> runs(static_cast<std::size_t>(count));
  parallel_for(count, [&](int k) { runs[k] = free_runs(grid_, slices + product(k, grid_.slice_size())); });
  for (const auto& slice : runs) add(slice);
}

void CavityFinder::add(const std::vector<VoxelRun>& runs) {
  open_.add(runs, by_faces_only);
  for (const VoxelRun& run : runs)
    rows_.push_back({run.end - run.begin,
                     {(run.begin + run.end) / 2, run.row, slices_},
                     run.begin == 0 || run.end == grid_.nx + 2});
  ++slices_;
  for (std::size_t run = 0; run < rows_.size(); ++run) {
    Row& whole = rows_[open_.set_of(run)];
    const bool outside = whole.outside || rows_[run].outside;
    if (rows_[run].length > whole.length) whole = rows_[run];
    whole.outside = outside;
  }
  std::vector<std::size_t> sets;
  for (std::size_t run = 0; run < rows_.size(); ++run) sets.push_back(open_.set_of(run));
  const std::vector<std::size_t> now = open_.forget([this](std::size_t set) {
    const std::int64_t voxels = open_.voxels(set);
    if (rows_[set].outside || voxels < least_voxels) return;
    ++closed_.count;
    closed_.voxels += voxels;
    if (voxels <= closed_.largest) return;
    closed_.largest = voxels;
    const auto& [x, y, z] = rows_[set].at;
    closed_.at_mm = {grid_.x_mm(x - 1), grid_.y_mm(y - 1), grid_.z_mm(z - 1)};
  });
  std::vector<Row> last(runs.size());
  for (std::size_t run = 0; run < rows_.size(); ++run) {
    if (now[run] != RunSets::gone) last[now[run]] = rows_[sets[run]];
  }
  rows_ = std::move(last);
}

Cavities CavityFinder::found() const {
  CavityFinder all = *this;
  all.add(free_runs(grid_, nullptr));
  return all.closed_;
}

}  // namespace vam::model
