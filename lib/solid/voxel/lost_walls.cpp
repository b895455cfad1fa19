// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/lost_walls.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::solid {

namespace {

constexpr float half = 0.5F;
constexpr float shut = 0.25F;              // covered by no more is free enough for a gap
constexpr float touching = 1 - 1 / 64.0F;  // covered by more is no gap

/// One voxel of the middle one of three slices, nullptr where there is none.
struct Place {
  const model::Grid& grid;
  const float* const* slices;
  int i, j;

  [[nodiscard]] bool at_border() const {
    return i == 0 || j == 0 || i == grid.nx - 1 || j == grid.ny - 1 || slices[0] == nullptr || slices[2] == nullptr;
  }
  /// Whether the voxel itself or one of its 26 neighbours fulfils the condition.
  template <class Condition>
  [[nodiscard]] bool near(const Condition& condition) const {
    for (int w = 0; w < 3; ++w) {
      if (slices[w] == nullptr) continue;
      for (int v = std::max(j - 1, 0); v <= std::min(j + 1, grid.ny - 1); ++v) {
        const float* row = slices[w] + product(v, grid.nx);
        if (std::any_of(row + std::max(i - 1, 0), row + std::min(i + 2, grid.nx), condition)) return true;
      }
    }
    return false;
  }
  /// Free shares of it and its two neighbours along the axis of which that is least. Not at the border.
  [[nodiscard]] float gap() const {
    const std::size_t at = product(j, grid.nx) + static_cast<std::size_t>(i);
    const float* middle = slices[1] + at;
    const float across =
        std::max({middle[-1] + middle[1], *(middle - grid.nx) + middle[grid.nx], slices[0][at] + slices[2][at]});
    return 3 - across - *middle;
  }
};

/// Of the middle one of three slices.
Lost of_slice(const model::Grid& grid, const float* const* slices) {
  Lost lost;
  const float* coverage = slices[1];
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i, ++coverage) {
      const float covered = *coverage;
      if (covered <= model::coverage_rounding || covered >= touching) continue;
      const Place place{grid, slices, i, j};
      if (covered < half && !place.near([](float c) { return c >= half; })) {
        lost.walls.voxels += covered;
        lost.walls.most = std::max(lost.walls.most, covered);
      }
      if (covered > shut && !place.at_border() && !place.near([](float c) { return c <= shut; })) {
        lost.gaps.voxels += 1 - covered;
        lost.gaps.widest = std::max(lost.gaps.widest, place.gap());
      }
    }
  }
  return lost;
}

/// What a slice holds is added to the sums; their size is its own.
template <class Sums>
void add_slice(Sums& sums, const Sums& slice, float Sums::*size, int number) {
  if (slice.voxels == 0) return;
  if (sums.voxels == 0) sums.first = number;
  sums.end = number + 1;
  sums.voxels += slice.voxels;
  sums.*size = std::max(sums.*size, slice.*size);
}

}  // namespace

/// All but the first and the last, which are neighbours only; slices[0] is slice number `first`.
void LostFinder::judge(const std::vector<const float*>& slices, int first) {
  if (slices.size() < 3) return;
  std::vector<Lost> lost(slices.size() - 2);
  parallel_for(count_of(lost), [&](int k) { lost[k] = of_slice(grid_, &slices[k]); });
  for (int k = 0; k < count_of(lost); ++k) {
    add_slice(found_.walls, lost[k].walls, &LostWalls::most, first + 1 + k);
    add_slice(found_.gaps, lost[k].gaps, &LostGaps::widest, first + 1 + k);
  }
}

/// Those of which the neighbours above are still to come, and one below them.
std::vector<const float*> LostFinder::open() const {
  std::vector<const float*> slices;
  if (added_ < 2) slices.push_back(nullptr);
  for (std::size_t at = 0; at < kept_.size(); at += grid_.slice_size()) slices.push_back(kept_.data() + at);
  return slices;
}

void LostFinder::add(int count, const float* slices) {
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

Lost LostFinder::finish() {
  std::vector<const float*> all = open();
  all.push_back(nullptr);
  judge(all, first_open());
  return found_;
}

}  // namespace vam::solid
