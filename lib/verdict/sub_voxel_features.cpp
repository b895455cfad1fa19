// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/sub_voxel_features.hpp"

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"
#include "verdict/defect_voxels.hpp"

namespace vam::verdict {

namespace {

constexpr float half = 0.5F;
constexpr float shut = 0.249F;             // covered by no more, with rounding, is free enough for a gap
constexpr float touching = 1 - 1 / 64.0F;  // covered by more is no gap

/// One voxel of the middle one of three slices, nullptr where there is none.
struct Place {
  int width, height;
  const float* const* slices;
  int i, j;

  [[nodiscard]] bool at_border() const {
    return i == 0 || j == 0 || i == width - 1 || j == height - 1 || slices[0] == nullptr || slices[2] == nullptr;
  }
  /// Whether the voxel itself or one of its 26 neighbours fulfils the condition.
  template <class Condition>
  [[nodiscard]] bool near(const Condition& condition) const {
    for (int w = 0; w < 3; ++w) {
      if (slices[w] == nullptr) continue;
      for (int v = std::max(j - 1, 0); v <= std::min(j + 1, height - 1); ++v) {
        const float* row = slices[w] + product(v, width);
        if (std::any_of(row + std::max(i - 1, 0), row + std::min(i + 2, width), condition)) return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool near_part() const {
    return near([](float c) { return model::label_of(c) == model::Label::part; });
  }
  [[nodiscard]] bool is_of_lost_wall(float covered) const {
    return covered < half && !near([](float c) { return c >= half; });
  }
  [[nodiscard]] bool near_void() const {
    return at_border() || near([](float c) { return model::label_of(c) == model::Label::void_; });
  }
  /// Free shares of it and its two neighbours along the axis of which that is least. Not at the border.
  [[nodiscard]] float gap() const {
    const std::size_t at = product(j, width) + static_cast<std::size_t>(i);
    const float* middle = slices[1] + at;
    const float across =
        std::max({middle[-1] + middle[1], *(middle - width) + middle[width], slices[0][at] + slices[2][at]});
    return 3 - across - *middle;
  }
};

/// Whether a voxel that is half covered lies within `reach` voxels of one in the middle one of 2 reach + 1 slices.
bool has_solid_within(int reach, const float* const* slices, int width, int height, int i, int j) {
  for (int w = 0; w <= 2 * reach; ++w) {
    if (slices[w] == nullptr) continue;
    for (int v = std::max(j - reach, 0); v <= std::min(j + reach, height - 1); ++v) {
      const float* row = slices[w] + product(v, width);
      const auto solid = [](float c) { return c >= half; };
      if (std::any_of(row + std::max(i - reach, 0), row + std::min(i + reach + 1, width), solid)) return true;
    }
  }
  return false;
}

template <class Sums>
void add_slice(Sums& sums, const Sums& slice, float Sums::*size, int number) {
  if (slice.voxels == 0) return;
  if (sums.voxels == 0) sums.first = number;
  sums.end = number + 1;
  sums.voxels += slice.voxels;
  sums.*size = std::max(sums.*size, slice.*size);
}

}  // namespace

std::string SubVoxelFeatures::thin_places() const {
  if (!surface) return "";
  const auto voxels_of = [&](const char* kind, const model::ThinPlaces& places) {
    return std::string(kind) + " of " + format_number(places.mm / surface->voxel_mm, 2) + " voxels";
  };
  std::string text;
  if (surface->has_thin_walls() && !loses_walls()) text = voxels_of("walls", surface->places.walls);
  if (surface->has_thin_gaps() && !bridges_gaps())
    text += (text.empty() ? "" : " and ") + voxels_of("gaps", surface->thin_gaps());
  if (text.empty() && surface->has_relief() && !loses_walls() && !bridges_gaps())
    text = voxels_of("ridges and grooves", surface->places.relief);
  return text;
}

bool SubVoxelFeatures::bridges_gaps() const {
  constexpr double least = 1;  // voxels
  constexpr double least_a_slice = 0.1;
  constexpr float least_width = 0.05F;  // voxels
  if (surface && !surface->may_lose_gaps()) return false;
  return lost_gaps.voxels >= least && lost_gaps.voxels >= least_a_slice * (lost_gaps.end - lost_gaps.first) &&
         lost_gaps.widest >= least_width;
}

std::vector<std::size_t> lost_walls(int width, int height, const float* const* slices) {
  std::vector<std::size_t> voxels;
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const std::size_t at = product(j, width) + static_cast<std::size_t>(i);
      const float covered = slices[1][at];
      if (model::label_of(covered) != model::Label::surface) continue;
      if (Place{width, height, slices, i, j}.is_of_lost_wall(covered)) voxels.push_back(at);
    }
  }
  return voxels;
}

/// Of the middle one of 2 reach + 1 slices.
SubVoxelFinder::Slice SubVoxelFinder::of_slice(const float* const* slices) const {
  Slice sums;
  const float* coverage = slices[reach];
  for (int j = 0; j < height_; ++j) {
    for (int i = 0; i < width_; ++i, ++coverage) {
      const float covered = *coverage;
      sums.whole += covered;
      if (model::label_of(covered) != model::Label::surface) continue;
      const Place place{width_, height_, slices + reach - 1, i, j};
      if (!place.near_part()) {
        sums.part += covered;
        if (place.is_of_lost_wall(covered)) {
          sums.walls.voxels += covered;
          sums.walls.most = std::max(sums.walls.most, covered);
          if (!has_solid_within(reach, slices, width_, height_, i, j)) sums.walls.far += covered;
        }
      }
      if (!place.near_void()) {
        sums.gaps += 1 - covered;
        if (covered > shut && covered < touching && !place.near([](float c) { return c <= shut; })) {
          sums.lost.voxels += 1 - covered;
          sums.lost.widest = std::max(sums.lost.widest, place.gap());
        }
      }
    }
  }
  return sums;
}

/// All but the first and the last, which are neighbours only.
std::vector<SubVoxelFinder::Slice> SubVoxelFinder::judged(const std::vector<const float*>& slices) const {
  std::vector<Slice> found(std::max(count_of(slices) - 2 * reach, 0));
  parallel_for(count_of(found), [&](int k) { found[k] = of_slice(&slices[k]); });
  return found;
}

/// Those of which neighbours above are still to come, and their neighbours below.
std::vector<const float*> SubVoxelFinder::open() const {
  const int open = std::min(added_, reach);
  const int kept = std::min(added_, 2 * reach);
  std::vector<const float*> slices(reach - (kept - open), nullptr);
  for (int k = 0; k < kept; ++k) slices.push_back(kept_.data() + product(k, product(width_, height_)));
  return slices;
}

void SubVoxelFinder::add(int count, const float* slices) {
  const std::size_t size = product(width_, height_);
  std::vector<const float*> all = open();
  for (int k = 0; k < count; ++k) all.push_back(slices + product(k, size));
  const std::vector<Slice> next = judged(all);
  slices_.insert(slices_.end(), next.begin(), next.end());
  added_ += count;
  std::vector<float> last;
  const std::size_t keep = std::min(added_, 2 * reach);
  for (std::size_t k = all.size() - keep; k < all.size(); ++k) last.insert(last.end(), all[k], all[k] + size);
  kept_ = std::move(last);
}

SubVoxelFeatures SubVoxelFinder::found() const {
  std::vector<const float*> last = open();
  last.insert(last.end(), reach, nullptr);
  std::vector<Slice> slices = slices_;
  const std::vector<Slice> top = judged(last);
  slices.insert(slices.end(), top.begin(), top.end());
  constexpr double much = 0.1;
  SubVoxelFeatures all;
  double most = 0;
  for (int k = 0; k < count_of(slices); ++k) {
    const Slice& one = slices[k];
    all.part += one.part;
    all.gaps += one.gaps;
    all.whole += one.whole;
    add_slice(all.lost_walls, one.walls, &LostWalls::most, k);
    all.lost_walls.far += one.walls.far;
    add_slice(all.lost_gaps, one.lost, &LostGaps::widest, k);
    if (one.part + one.gaps <= most) continue;
    most = one.part + one.gaps;
    all.slice = k;
  }
  for (int k = 0; k < count_of(slices) && most > 0; ++k) {
    if (slices[k].part + slices[k].gaps < much * most) continue;
    if (all.end == 0) all.first = k;
    all.end = k + 1;
  }
  return all;
}

}  // namespace vam::verdict
