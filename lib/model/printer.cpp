// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/printer.hpp"

namespace vam::model {

namespace {

std::optional<double> lens_mm(const Projector& projector, bool telecentric) {
  if (telecentric) return std::nullopt;
  return lens_distance_mm(projector);
}

/// Where finer sample `at` is among samples of twice the size: sample 0.5 is the middle of the first.
double among_coarser(double at) { return 0.5 * (at - 0.5); }

}  // namespace

double lens_distance_mm(const Projector& projector) {
  return projector.lens_distance_mm.value_or(projector.throw_ratio * projector.columns * projector.pixel_mm);
}

std::optional<double> columns_lens_mm(const Projector& projector) {
  return lens_mm(projector, projector.telecentric || projector.telecentric_columns);
}

std::optional<double> rows_lens_mm(const Projector& projector) {
  return lens_mm(projector, projector.telecentric || projector.telecentric_rows);
}

double resin_radius_mm(const Vial& vial) { return vial.radius_mm - vial.wall_mm; }

Printer coarser(const Printer& printer) {
  Printer coarse = printer;
  Projector& p = coarse.projector;
  p.lens_distance_mm = lens_distance_mm(p);
  p.columns = (p.columns + 1) / 2;
  p.rows = (p.rows + 1) / 2;
  p.pixel_mm = 2 * p.pixel_mm;
  p.axis_column = among_coarser(p.axis_column);
  p.axis_row = among_coarser(p.axis_row);
  return coarse;
}

}  // namespace vam::model
