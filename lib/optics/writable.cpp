#include "optics/writable.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "optics/vial.hpp"

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

}  // namespace vam::optics
