// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/circle.hpp"

#include "testing.hpp"

using namespace vam::model;

TEST_CASE("the writable circle is the smaller of the printer's and the grid's") {
  constexpr double radius_mm = 8.3;
  const auto wide = writable_circle(centred_grid(101, 101, 1, 0.5), radius_mm);
  CHECK(wide.axis_x == doctest::Approx(50));
  CHECK(wide.radius == doctest::Approx(radius_mm / 0.5));
  CHECK(writable_circle(centred_grid(21, 31, 1, 0.5), radius_mm).radius == doctest::Approx(10.5));
  CHECK(judged_circle(centred_grid(21, 31, 1, 0.5), radius_mm).radius == doctest::Approx(radius_mm / 0.5));
  CHECK_THROWS_AS((void)judged_circle({10, 10, 1, 0.5, {3, 0, 0}}, radius_mm), vam::Error);
  CHECK_THROWS_AS((void)writable_circle({10, 10, 1, 0.5, {3, 0, 0}}, radius_mm), vam::Error);
}

TEST_CASE("the nearest of four sides bounds the circle") {
  // The axis is 3, 4, 5 and 6 voxels from the middle of the outermost voxel of a side, whichever that is.
  for (const auto& [left, right, front, back] :
       {std::array{3, 4, 5, 6}, std::array{4, 3, 6, 5}, std::array{5, 6, 3, 4}, std::array{6, 5, 4, 3}}) {
    const Grid grid{left + right + 1, front + back + 1, 1, 0.5, {-0.5 * left, -0.5 * front, 0}};
    const Circle circle = writable_circle(grid, 100);
    CHECK(circle.axis_x == left);
    CHECK(circle.axis_y == front);
    CHECK(circle.radius == 3.5);
  }
}
