#include "model/printer.hpp"

#include <algorithm>

namespace vam::model {

std::optional<double> lens_distance_mm(const Projector& projector) {
  if (projector.telecentric) return std::nullopt;
  if (projector.lens_distance_mm) return projector.lens_distance_mm;
  return projector.throw_ratio * projector.columns * projector.pixel_mm;
}

double resin_radius_mm(const Vial& vial) { return vial.radius_mm - vial.wall_mm; }

double writable_radius_mm(const Printer& printer) {
  // n b is conserved through concentric shells (Bouguer): the outermost ray, b = R, ends up at R n_0 / n_resin.
  return std::min(resin_radius_mm(printer.vial), printer.vial.radius_mm * printer.bath.index / printer.resin.index);
}

double vertical_magnification(const Printer& printer) {
  const auto distance_mm = lens_distance_mm(printer.projector);
  if (!distance_mm) return 1.0;
  return 1.0 - printer.vial.radius_mm * (1.0 - printer.bath.index / printer.resin.index) / *distance_mm;
}

}  // namespace vam::model
