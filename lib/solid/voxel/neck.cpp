// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/private/neck.hpp"

#include <algorithm>
#include <cmath>

#include "base/buckets.hpp"
#include "base/disjoint_sets.hpp"

namespace vam::solid {

namespace {

/// The solid voxels, the deepest first.
std::vector<std::int32_t> by_depth(const std::vector<std::int32_t>& squared) {
  const std::int32_t deepest = squared.empty() ? 0 : *std::max_element(squared.begin(), squared.end());
  return Buckets<std::int32_t>(static_cast<std::size_t>(deepest),
                               [&](const auto& put) {
                                 for (std::size_t at = 0; at < squared.size(); ++at)
                                   if (squared[at] > 0) put(deepest - squared[at], static_cast<std::int32_t>(at));
                               })
      .items();
}

}  // namespace

std::vector<std::int64_t> necks(const std::array<int, 3>& size, const std::vector<std::int32_t>& squared,
                                std::int32_t most, double least_deeper) {
  const auto depth_of = [&](std::int32_t voxel) { return squared[voxel]; };
  std::array<std::int32_t, 26> around{};
  for (int n = 0; n < 27; ++n) {
    if (n == 13) continue;
    around[n < 13 ? n : n - 1] = (n / 9 - 1) * size[0] * size[1] + (n / 3 % 3 - 1) * size[0] + n % 3 - 1;
  }
  std::vector<std::int64_t> found;
  DisjointSets<std::int32_t> sets(squared.size());  // of voxels that touch; each is named by its deepest one
  for (const std::int32_t voxel : by_depth(squared)) {
    std::int32_t own = voxel;
    for (const std::int32_t step : around) {
      const std::int32_t beside = voxel + step;
      const bool is_earlier = depth_of(beside) > depth_of(voxel) || (depth_of(beside) == depth_of(voxel) && step < 0);
      if (!is_earlier) continue;
      std::int32_t other = sets.of(beside);
      if (other == own) continue;
      if (depth_of(own) < depth_of(other)) std::swap(own, other);
      sets.join(own, other);
      const bool is_narrow = depth_of(voxel) <= most;
      if (is_narrow && std::sqrt(depth_of(other)) >= std::sqrt(depth_of(voxel)) + least_deeper) found.push_back(voxel);
    }
  }
  return found;
}

}  // namespace vam::solid
