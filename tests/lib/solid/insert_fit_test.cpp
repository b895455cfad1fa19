// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/insert_fit.hpp"

#include "testing.hpp"

using namespace vam;

TEST_CASE("an insert's slices are read once each, and grow by the clearance along the grid") {
  const model::Grid grid = model::centred_grid(9, 9, 5, 0.1);
  std::vector<int> read;
  const auto slice = [&](int k, float* out) {  // one full column, in all slices but the first
    read.push_back(k);
    std::fill(out, out + grid.slice_size(), 0.0F);
    if (k > 0) out[4 * 9 + 4] = 1;
  };
  const double clearance_mm = 0.15;  // of 1.5 voxels
  const solid::GrownInsert grown(grid, slice, clearance_mm, 1);
  CHECK(read == std::vector<int>{0, 1, 2, 3, 4});
  std::vector<float> values(grid.slice_size(), 0.0F);
  grown.grow(3, values.data());
  const auto at = [&](int i, int j) { return doctest::Approx(values[j * 9 + i]); };
  CHECK(at(4, 4) == 1);
  CHECK(at(5, 4) == 1);
  CHECK(at(4, 2) == 0.5);
  CHECK(at(7, 4) == 0);
  std::fill(values.begin(), values.end(), 0.0F);
  grown.grow(0, values.data());  // below its end
  CHECK(at(4, 4) == 1);
  CHECK(at(6, 4) == 2.5 - std::sqrt(5.0));
}

TEST_CASE("a gap is shut on the lines on which no voxel is more than three quarters free") {
  const model::Grid grid = model::centred_grid(9, 9, 3, 0.1);
  const auto shut =
      [&](float in_gap) {  // a column in the middle, the part two voxels away on one side, at the other far
        std::vector<float> part(grid.slice_size(), 0.0F);
        std::vector<float> insert(grid.slice_size(), 0.0F);
        insert[4 * 9 + 4] = 1;
        part[4 * 9 + 5] = in_gap;
        part[4 * 9 + 6] = part[0 * 9 + 4] = 1;
        part[5 * 9 + 4] = 1;  // touches along y: shut, whatever the gap
        solid::InsertFit fit(grid, 0.1);
        for (int k = 0; k < 3; ++k) fit.add(part.data(), insert.data());
        return fit.shut_share();
      };
  CHECK(shut(0.2F) == 0.5);
  CHECK(shut(0.3F) == 1);
}
