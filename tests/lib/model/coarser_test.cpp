// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/coarser.hpp"

#include "testing.hpp"

using namespace vam::model;

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
