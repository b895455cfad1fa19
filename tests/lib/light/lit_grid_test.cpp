// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/lit_grid.hpp"

#include "testing.hpp"

using namespace vam;

TEST_CASE("a slice and a box of a grid keep their place in the grid with a margin") {
  const model::Grid grid = model::centred_grid(3, 2, 2, 0.5, 0);
  const light::Margin margin{2, 1, 3};
  const model::Grid wide = light::extended(grid, margin);
  const std::vector<float> slice{1, 2, 3, 4, 5, 6};
  std::vector<float> to(wide.slice_size(), 9);
  light::place_slice(slice.data(), grid, margin, to.data());
  const model::VoxelBox box = light::moved({{1, 0, 1}, {2, 1, 1}}, margin);
  CHECK(wide.x_mm(box.low[0]) == doctest::Approx(grid.x_mm(1)));
  CHECK(wide.z_mm(box.high[2]) == doctest::Approx(grid.z_mm(1)));
  CHECK(to[static_cast<std::size_t>(box.low[1]) * wide.nx + box.low[0]] == 2);
  CHECK(to[static_cast<std::size_t>(box.high[1]) * wide.nx + box.high[0]] == 6);
  CHECK(to.front() == 9);
  CHECK(to.back() == 9);
  CHECK(light::round_margin(grid, 0.5).side == 0);  // its narrow side is 1 mm
  CHECK(light::round_margin(grid, 1.01).side == 2);
}
