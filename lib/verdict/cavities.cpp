// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/cavities.hpp"

#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "model/dose/dose_metrics.hpp"
#include "verdict/private/bit_slice.hpp"
#include "verdict/private/pieces.hpp"

namespace vam::verdict {

namespace {

constexpr std::int64_t least_voxels = 8;

/// Runs of void in a slice with its margin.
std::vector<VoxelRun> free_runs(const model::Grid& grid, const float* slice) {
  return BitSlice(grid.nx, grid.ny, false, [&](std::size_t pixel) { return model::half_covered(slice[pixel]); })
      .runs(false, true);
}

std::vector<VoxelRun> margin_runs(const model::Grid& grid) { return BitSlice(grid.nx, grid.ny).runs(false, true); }

}  // namespace

class CavityFinder::State {
 public:
  explicit State(const model::Grid& grid) : grid_(grid) { add(margin_runs(grid_)); }
  void add(int count, const float* slices);
  [[nodiscard]] Cavities found() const;

 private:
  /// The longest row of a cavity.
  struct Row {
    int length = 0;
    std::array<int, 3> at{};
    bool outside = false;  // some row of this piece is on the margin
  };
  void add(const std::vector<VoxelRun>& runs);

  model::Grid grid_;
  RunSets open_;           // that reach the last slice
  std::vector<Row> rows_;  // of each run
  int slices_ = -1;        // so far, without the margin below
  Cavities closed_;
};

void CavityFinder::State::add(int count, const float* slices) {
  std::vector<std::vector<VoxelRun>> runs(static_cast<std::size_t>(count));
  parallel_for(count, [&](int k) { runs[k] = free_runs(grid_, slices + product(k, grid_.slice_size())); });
  for (const auto& slice : runs) add(slice);
}

void CavityFinder::State::add(const std::vector<VoxelRun>& runs) {
  open_.add(runs, Touching::faces);
  for (const VoxelRun& run : runs)
    rows_.push_back(
        {run.end - run.begin, {(run.begin + run.end) / 2, run.row, slices_}, run.begin < 0 || run.end > grid_.nx});
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
    const std::int64_t voxels = open_[set].voxels;
    if (rows_[set].outside || voxels < least_voxels) return;
    ++closed_.count;
    closed_.voxels += voxels;
    if (voxels <= closed_.largest) return;
    closed_.largest = voxels;
    const auto& [x, y, z] = rows_[set].at;
    closed_.at_mm = {grid_.x_mm(x), grid_.y_mm(y), grid_.z_mm(z)};
  });
  std::vector<Row> last(runs.size());
  for (std::size_t run = 0; run < rows_.size(); ++run) {
    if (now[run] != RunSets::gone) last[now[run]] = rows_[sets[run]];
  }
  rows_ = std::move(last);
}

Cavities CavityFinder::State::found() const {
  State all = *this;
  all.add(margin_runs(grid_));
  return all.closed_;
}

CavityFinder::CavityFinder(const model::Grid& grid) : state_(std::make_unique<State>(grid)) {}
CavityFinder::~CavityFinder() = default;

void CavityFinder::add(int count, const float* slices) { state_->add(count, slices); }
Cavities CavityFinder::found() const { return state_->found(); }

}  // namespace vam::verdict
