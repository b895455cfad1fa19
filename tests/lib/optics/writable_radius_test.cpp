// SPDX-License-Identifier: GPL-3.0-or-later
// How far from the axis a printer writes.
#include "optics/writable_radius.hpp"

#include "testing.hpp"

using namespace vam;
using optics::writable_radius_mm;

TEST_CASE("the default printer writes up to the outermost ray of the vial") {
  CHECK(writable_radius_mm({}) == doctest::Approx(12.7 / 1.53));
}

TEST_CASE("a glass wall does not narrow what is lit, until the resin itself ends") {
  model::Printer printer;
  printer.vial.wall_mm = 1;
  CHECK(writable_radius_mm(printer) == doctest::Approx(12.7 / 1.53));
  printer.vial.wall_mm = 6;
  CHECK(writable_radius_mm(printer) == doctest::Approx(6.7));
}

TEST_CASE("a matched bath opens the whole vial") {
  CHECK(writable_radius_mm(model::Printer{.bath = {1.53, 20}}) == doctest::Approx(12.7));
}

TEST_CASE("too few columns reduce the writable radius, the narrower side decides") {
  model::Printer printer{.projector = {.columns = 201, .lens_distance_mm = 120, .axis_column = 100}};
  const double edge_mm = 100 * 0.065;
  const double narrow = edge_mm / std::hypot(1, edge_mm / 120) / 1.53;  // b / n, in air
  CHECK(writable_radius_mm(printer) == doctest::Approx(narrow));
  printer.projector.axis_column = 120;
  CHECK(writable_radius_mm(printer) < narrow);
  printer.projector.telecentric = true;
  CHECK(writable_radius_mm(printer) == doctest::Approx(80 * 0.065 / 1.53));
  printer.projector.axis_column = 201;
  CHECK_THROWS_WITH_AS((void)writable_radius_mm(printer), doctest::Contains("outside its columns 0 to 200"), Error);
}

TEST_CASE("a printer with its lens inside the vial has no writable radius") {
  model::Printer printer;
  printer.projector.lens_distance_mm = 10;
  CHECK_THROWS_AS((void)writable_radius_mm(printer), Error);
}

TEST_CASE("all resin is judged for a part that reaches beyond the writable radius") {
  const model::Printer printer;
  CHECK(optics::judged_radius_mm(printer, 8.3) == writable_radius_mm(printer));
  CHECK(optics::judged_radius_mm(printer, 8.31) == 12.7);
}
