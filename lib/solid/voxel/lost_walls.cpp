// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/lost_walls.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::solid {

namespace {

constexpr float half = 0.5F;

/// Whether a voxel of the three slices about (i, j) is half covered; nullptr: no slice.
bool near_half(const model::Grid& grid, const float* const* slices, int i, int j) {
  for (int w = 0; w < 3; ++w) {
    if (slices[w] == nullptr) continue;
    for (int v = std::max(j - 1, 0); v <= std::min(j + 1, grid.ny - 1); ++v) {
      const float* row = slices[w] + product(v, grid.nx);
      if (std::any_of(row + std::max(i - 1, 0), row + std::min(i + 2, grid.nx), [](float c) { return c >= half; })) {
        return true;
      }
    }
  }
  return false;
}

/// Of the middle one of three slices.
LostWalls of_slice(const model::Grid& grid, const float* const* slices) {
  LostWalls lost;
  const float* coverage = slices[1];
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i, ++coverage) {
      if (*coverage <= model::coverage_rounding || *coverage >= half || near_half(grid, slices, i, j)) continue;
      lost.voxels += *coverage;
      lost.most = std::max(lost.most, *coverage);
    }
  }
  return lost;
}

}  // namespace

/// All but the first and the last, which are neighbours only; slices[0] is slice number `first`.
void LostWallFinder::judge(const std::vector<const float*>& slices, int first) {
  if (slices.size() < 3) return;
  std::vector<LostWalls> lost(slices.size() - 2);
  parallel_for(count_of(lost), [&](int k) { lost[k] = of_slice(grid_, &slices[k]); });
  for (int k = 0; k < count_of(lost); ++k) {
    if (lost[k].voxels == 0) continue;
    const int number = first + 1 + k;
    if (found_.voxels == 0) found_.first = number;
    found_.end = number + 1;
    found_.voxels += lost[k].voxels;
    found_.most = std::max(found_.most, lost[k].most);
  }
}

/// Those of which the neighbours above are still to come, and one below them.
std::vector<const float*> LostWallFinder::open() const {
  std::vector<const float*> slices;
  if (added_ < 2) slices.push_back(nullptr);
  for (std::size_t at = 0; at < kept_.size(); at += grid_.slice_size()) slices.push_back(kept_.data() + at);
  return slices;
}

void LostWallFinder::add(int count, const float* slices) {
  const std::size_t size = grid_.slice_size();
  std::vector<const float*> all = open();
  for (int k = 0; k < count; ++k) all.push_back(slices + product(k, size));
  judge(all, first_open());
  added_ += count;
  std::vector<float> last;
  const std::size_t keep = std::min(added_, 2);
  for (std::size_t k = all.size() - keep; k < all.size(); ++k) last.insert(last.end(), all[k], all[k] + size);
  kept_ = std::move(last);
}

LostWalls LostWallFinder::finish() {
  std::vector<const float*> all = open();
  all.push_back(nullptr);
  judge(all, first_open());
  return found_;
}

}  // namespace vam::solid
