#include "model/printer.hpp"

namespace vam::model {

namespace {

std::optional<double> lens_mm(const Projector& projector, bool telecentric) {
  if (telecentric) return std::nullopt;
  if (projector.lens_distance_mm) return projector.lens_distance_mm;
  return projector.throw_ratio * projector.columns * projector.pixel_mm;
}

}  // namespace

std::optional<double> columns_lens_mm(const Projector& projector) {
  return lens_mm(projector, projector.telecentric || projector.telecentric_columns);
}

std::optional<double> rows_lens_mm(const Projector& projector) {
  return lens_mm(projector, projector.telecentric || projector.telecentric_rows);
}

double resin_radius_mm(const Vial& vial) { return vial.radius_mm - vial.wall_mm; }

double shortening_mm(const Printer& printer, double index_resin) {
  const Vial& vial = printer.vial;
  double sum = printer.bath.index == 1.0 ? 0 : printer.bath.window_mm * (1 - 1 / printer.bath.index);
  double before = printer.bath.index;
  if (vial.wall_mm > 0) {
    sum += vial.radius_mm * (1 / before - 1 / vial.index_glass);
    before = vial.index_glass;
  }
  return sum + resin_radius_mm(vial) * (1 / before - 1 / index_resin);
}

double vertical_magnification(const Printer& printer) {
  const auto distance_mm = rows_lens_mm(printer.projector);
  return distance_mm ? 1.0 - shortening_mm(printer, printer.resin.index) / *distance_mm : 1.0;
}

}  // namespace vam::model
