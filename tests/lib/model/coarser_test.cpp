// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/coarser.hpp"

#include "testing.hpp"

using namespace vam::model;

TEST_CASE("a coarser voxel is where the eight that it covers are") {
  const Grid fine{5, 4, 3, 0.1, {-0.2, -0.15, 0.7}};
  const Grid coarse = coarser(fine);
  CHECK(coarse.nx == 3);
  CHECK(coarse.ny == 2);
  CHECK(coarse.nz == 2);
  CHECK(coarse.voxel_mm == doctest::Approx(0.2));
  CHECK(coarse.x_mm(1) == doctest::Approx(0.5 * (fine.x_mm(2) + fine.x_mm(3))));
  CHECK(coarse.y_mm(1) == doctest::Approx(0.5 * (fine.y_mm(2) + fine.y_mm(3))));
  CHECK(coarse.z_mm(0) == doctest::Approx(0.5 * (fine.z_mm(0) + fine.z_mm(1))));
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
