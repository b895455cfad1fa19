// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/writable_radius.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::optics {

double largest_invariant(const View& view) {
  double outside = view.bath_index;
  double most = outside * view.shells.front().radius_mm;
  for (const Shell& shell : view.shells) {
    most = std::min(most, std::min(outside, shell.index) * shell.radius_mm);
    outside = shell.index;
  }
  return most;
}

double grazing_impact_mm(const View& view) { return largest_invariant(view) / view.bath_index; }

double reach_mm(const View& view) { return largest_invariant(view) / view.shells.back().index; }

double writable_radius_mm(const model::Printer& printer) {
  const model::Projector& projector = printer.projector;
  const int last = projector.columns - 1;
  if (!projector.shows_axis()) {
    throw Error{Fault::data, "projector: the rotation axis, at column " + format_number(projector.axis_column) +
                                 ", is outside its columns 0 to " + std::to_string(last) +
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
