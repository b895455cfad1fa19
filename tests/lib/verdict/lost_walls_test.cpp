// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/index.hpp"
#include "testing.hpp"
#include "verdict/defect_voxels.hpp"
#include "verdict/sub_voxel_features.hpp"

using namespace vam;
using namespace vam::model;
using namespace vam::verdict;

namespace {

constexpr int n = 6;

/// Slices handed over `a_pass` at a time.
SubVoxelFeatures found(const std::vector<float>& values, int a_pass) {
  const int nz = static_cast<int>(values.size()) / (n * n);
  SubVoxelFinder finder(model::centred_grid(n, n, nz, 0.1));
  for (int k = 0; k < nz; k += a_pass) finder.add(std::min(a_pass, nz - k), values.data() + product(k, n * n));
  return finder.found();
}

void set(std::vector<float>& values, int i, int j, int k, float coverage) {
  values[product(k, n * n) + product(j, n) + i] = coverage;
}

}  // namespace

TEST_CASE("walls are lost where neither a voxel nor its 26 neighbours are half covered, in passes of any size") {
  std::vector<float> values(product(n * n, 9), 0.0F);
  for (int k = 0; k < 3; ++k) set(values, 2, 2, k, 1);  // a pillar, with a fin that goes on above it
  for (int k = 0; k < 8; ++k) set(values, 3, 3, k, 0.25F);
  set(values, 5, 5, 0, 0.1F);  // a speck, at the edge
  for (const int a_pass : {1, 2, 3, 4, 9}) {
    CAPTURE(a_pass);
    const LostWalls lost = found(values, a_pass).lost_walls;
    CHECK(lost.voxels == doctest::Approx(4 * 0.25 + 0.1));  // slice 3 of the fin touches the pillar by a corner
    CHECK(lost.first == 0);
    CHECK(lost.end == 8);
    CHECK(lost.most == 0.25F);
    CHECK(lost.far == doctest::Approx(2 * 0.25));  // slices 6 and 7 are four and five above the pillar
  }
  set(values, 4, 3, 7, 0.5F);  // half covered: it and its neighbours, below it too
  CHECK(found(values, 4).lost_walls.voxels == doctest::Approx(2 * 0.25 + 0.1));
}

TEST_CASE("a single slice, and none") {
  std::vector<float> values(product(n * n, 1), 0.0F);
  CHECK(found(values, 1).lost_walls.voxels == 0);
  set(values, 1, 1, 0, 0.3F);
  const LostWalls lost = found(values, 1).lost_walls;
  CHECK(lost.voxels == doctest::Approx(0.3));
  CHECK(lost.first == 0);
  CHECK(lost.end == 1);
}

TEST_CASE(
    "gaps are lost where neither a voxel nor its 26 neighbours are more than three quarters free, in passes of any "
    "size") {
  std::vector<float> values(product(n * n, 9), 1.0F);
  for (int k = 2; k < 7; ++k) {  // a slit of half a voxel, in two layers; it ends within
    for (int j = 1; j < 5; ++j) {
      set(values, 2, j, k, 0.75F);
      set(values, 3, j, k, 0.75F);
    }
  }
  for (const int a_pass : {1, 2, 3, 4, 9}) {
    CAPTURE(a_pass);
    const LostGaps lost = found(values, a_pass).lost_gaps;
    CHECK(lost.voxels == doctest::Approx(5 * 4 * 2 * 0.25));
    CHECK(lost.first == 2);
    CHECK(lost.end == 7);
    CHECK(lost.widest == 0.5F);
  }
  CHECK(found(values, 9).lost_walls.voxels == 0);
  set(values, 4, 4, 6, 0.2F);  // a hole at its end: free, and so are its neighbours
  CHECK(found(values, 9).lost_gaps.voxels == doctest::Approx((5 * 4 * 2 - 4) * 0.25));
}

TEST_CASE("what is open to a side, and shells that nearly touch, are no gaps") {
  std::vector<float> values(product(n * n, 3), 1.0F);
  for (int j = 0; j < n; ++j) set(values, 3, j, 1, 0.99F);
  CHECK(found(values, 3).lost_gaps.voxels == 0);
  for (int j = 0; j < n; ++j) set(values, 0, j, 1, 0.5F);  // its other half may be beyond the grid
  CHECK(found(values, 3).lost_gaps.voxels == 0);
  set(values, 3, 3, 1, 0.5F);
  CHECK(found(values, 3).lost_gaps.voxels == doctest::Approx(0.5));
}
