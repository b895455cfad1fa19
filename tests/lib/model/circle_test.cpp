#include "model/circle.hpp"

#include <doctest/doctest.h>

#include "base/error.hpp"

using namespace vam::model;

TEST_CASE("the writable circle is the smaller of the printer's and the grid's") {
  const Printer printer;  // 12.7 mm / 1.53 = 8.3007 mm
  const auto wide = writable_circle(centred_grid(101, 101, 1, 0.5), printer);
  CHECK(wide.axis_x == doctest::Approx(50));
  CHECK(wide.radius == doctest::Approx(12.7 / 1.53 / 0.5));
  CHECK(writable_circle(centred_grid(21, 31, 1, 0.5), printer).radius == doctest::Approx(10.5));
  CHECK_THROWS_AS((void)writable_circle({10, 10, 1, 0.5, {3, 0, 0}}, printer), vam::Error);
}
