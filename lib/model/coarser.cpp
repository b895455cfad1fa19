// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/coarser.hpp"

namespace vam::model {

namespace {

/// Where finer sample `at` is among the coarser ones: sample 0.5 is the middle of the first.
double coarser(double at) { return 0.5 * (at - 0.5); }

}  // namespace

Printer coarser(const Printer& printer) {
  Printer coarse = printer;
  Projector& p = coarse.projector;
  p.lens_distance_mm = lens_distance_mm(p);
  p.columns = (p.columns + 1) / 2;
  p.rows = (p.rows + 1) / 2;
  p.pixel_mm = 2 * p.pixel_mm;
  p.axis_column = coarser(p.axis_column);
  p.axis_row = coarser(p.axis_row);
  return coarse;
}

}  // namespace vam::model
