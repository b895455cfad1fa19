// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/printer.hpp"

#include "model/magnification.hpp"
#include "testing.hpp"

using namespace vam::model;

TEST_CASE("the default printer is that of RAY21") {
  const Printer printer;
  CHECK(*columns_lens_mm(printer.projector) == doctest::Approx(1.8 * 1024 * 0.065));
}

TEST_CASE("vertical magnification follows [OST22 eq S5] and is 1 for a telecentric lens") {
  Printer printer;
  CHECK(vertical_magnification(printer) == doctest::Approx(1 - 12.7 * (1 - 1 / 1.53) / 119.808));
  printer.projector.telecentric = true;
  CHECK(vertical_magnification(printer) == 1.0);
  printer.projector.telecentric = false;
  printer.projector.telecentric_columns = true;
  CHECK(vertical_magnification(printer) < 1);
  printer.projector.telecentric_rows = true;
  CHECK(vertical_magnification(printer) == 1.0);
  printer.projector.telecentric_rows = false;  // an index bath behind a window: each layer shortens the way
  printer.bath = {1.4, 20};
  const double shortened = 20 * (1 - 1 / 1.4) + 12.7 * (1 / 1.4 - 1 / 1.53);
  CHECK(vertical_magnification(printer) == doctest::Approx(1 - shortened / 119.808));
  CHECK(1 / vertical_magnification(printer) == doctest::Approx(1.0572).epsilon(1e-4));
}

TEST_CASE(
    "the camera's magnification includes the shortening of the path by glass and resin; a telecentric one's does not") {
  Printer printer;
  printer.vial.wall_mm = 1.2;
  printer.vial.index_glass = 1.47;
  printer.camera.telecentric = false;
  printer.camera.distance_mm = 200;
  printer.camera.index_resin = 1.5;
  const double shortened = 12.7 * (1 - 1 / 1.47) + 11.5 * (1 / 1.47 - 1 / 1.5);
  CHECK(camera_magnification(printer) == doctest::Approx(1 / (1 - shortened / 200)).epsilon(1e-12));
  printer.camera.telecentric = true;
  CHECK(camera_magnification(printer) == 1);
}

TEST_CASE("coarser pixels are where the finer ones are, and the lens stays") {
  Printer fine{.projector = {.columns = 1025, .rows = 769, .axis_column = 500}};
  const Printer coarse = coarser(fine);
  CHECK(coarse.projector.columns == 513);
  CHECK(coarse.projector.rows == 385);
  const auto mm = [](double at, double axis, const Printer& printer) {
    return (at - axis) * printer.projector.pixel_mm;
  };
  CHECK(mm(100, coarse.projector.axis_column, coarse) == doctest::Approx(mm(200.5, fine.projector.axis_column, fine)));
  CHECK(mm(7, coarse.projector.axis_row, coarse) == doctest::Approx(mm(14.5, fine.projector.axis_row, fine)));
  CHECK(columns_lens_mm(coarse.projector).value() == doctest::Approx(columns_lens_mm(fine.projector).value()));
  fine.projector.telecentric = true;
  CHECK_FALSE(rows_lens_mm(coarser(fine).projector));
}
