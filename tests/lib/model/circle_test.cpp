#include "model/circle.hpp"

#include <doctest/doctest.h>

#include "base/error.hpp"

using namespace vam::model;

TEST_CASE("the writable circle is the smaller of the printer's and the grid's") {
  constexpr double radius_mm = 8.3;
  const auto wide = writable_circle(centred_grid(101, 101, 1, 0.5), radius_mm);
  CHECK(wide.axis_x == doctest::Approx(50));
  CHECK(wide.radius == doctest::Approx(radius_mm / 0.5));
  CHECK(writable_circle(centred_grid(21, 31, 1, 0.5), radius_mm).radius == doctest::Approx(10.5));
  CHECK_THROWS_AS((void)writable_circle({10, 10, 1, 0.5, {3, 0, 0}}, radius_mm), vam::Error);
}
