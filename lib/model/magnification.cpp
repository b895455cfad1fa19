// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/magnification.hpp"

namespace vam::model {

double shortening_mm(const Printer& printer, double index_resin) {
  const Vial& vial = printer.vial;
  double sum = printer.bath.window_mm * (1 - 1 / printer.bath.index);
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

double camera_magnification(const Printer& printer) {
  if (printer.camera.telecentric) return 1;
  return 1 / (1 - shortening_mm(printer, printer.camera.index_resin) / printer.camera.distance_mm);
}

}  // namespace vam::model
