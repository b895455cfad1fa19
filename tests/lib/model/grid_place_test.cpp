// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/grid_place.hpp"

#include "model/grid_size.hpp"
#include "testing.hpp"

using namespace vam::model;

TEST_CASE("a grid is found among the voxels of another, at the place of its first") {
  const Grid whole = centred_grid(10, 8, 6, 0.2, -0.5);
  Grid part{4, 2, 1, 0.2, {whole.x_mm(6), whole.y_mm(0), whole.z_mm(5)}};
  CHECK(place_in(whole, part) == std::array<int, 3>{6, 0, 5});
  CHECK(place_in(whole, whole) == std::array<int, 3>{0, 0, 0});
  part.origin_mm[0] += 1e-5;  // as a file rounds
  CHECK(place_in(whole, part) == std::array<int, 3>{6, 0, 5});
  part.origin_mm[0] += 0.2;  // one voxel over the edge
  CHECK_FALSE(place_in(whole, part));
  part.origin_mm[0] = whole.x_mm(-1);
  CHECK_FALSE(place_in(whole, part));
  part.origin_mm[0] = whole.x_mm(2.25);
  CHECK_FALSE(place_in(whole, part));
  part.origin_mm[0] = 1e300;
  CHECK_FALSE(place_in(whole, part));
}

TEST_CASE("grids have the same voxels where size, pitch and position agree") {
  const Grid grid = centred_grid(10, 8, 6, 0.2, -0.5);
  CHECK(same_voxels(grid, grid));
  CHECK_FALSE(same_voxels(grid, centred_grid(10, 8, 5, 0.2, -0.5)));
  CHECK_FALSE(same_voxels(grid, centred_grid(10, 8, 6, 0.25, -0.5)));
  CHECK_FALSE(same_voxels(grid, centred_grid(10, 8, 6, 0.2, -0.3)));
  CHECK(place_text(grid) == "10 x 8 x 6 voxels of 0.2 mm from (-0.9, -0.7, -0.5)");
}
