#include "optics/writable_radius.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "optics/chief_ray.hpp"

namespace vam::optics {

double writable_radius_mm(const model::Printer& printer) {
  const model::Projector& projector = printer.projector;
  const int last = projector.columns - 1;
  if (projector.axis_column < 0 || projector.axis_column > last) {
    throw Error{Fault::data, "projector: the rotation axis, at column " + format_number(projector.axis_column) +
                                 ", is beside its columns 0 ... " + std::to_string(last) +
                                 "; check projector.axis_column and projector.columns"};
  }
  const View view = projector_view(printer);
  double radius = reach_mm(view);
  for (const int edge : {0, last}) {
    const ChiefRay ray = chief_ray(view, (edge - projector.axis_column) * projector.pixel_mm);
    if (ray.hits) radius = std::min(radius, std::abs(ray.x_v_mm));
  }
  return radius;
}

double judged_radius_mm(const model::Printer& printer, double farthest_mm) {
  constexpr double rounding_mm = 1e-6;
  const double writable = writable_radius_mm(printer);
  return farthest_mm > writable + rounding_mm ? model::resin_radius_mm(printer.vial) : writable;
}

}  // namespace vam::optics
