// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/printer.hpp"

namespace vam::model {

namespace {

std::optional<double> lens_mm(const Projector& projector, bool telecentric) {
  if (telecentric) return std::nullopt;
  return lens_distance_mm(projector);
}

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

}  // namespace vam::model
