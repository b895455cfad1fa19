// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/ray_list.hpp"

#include <ostream>

#include "base/constants.hpp"
#include "base/text/text.hpp"
#include "model/rows.hpp"
#include "optics/skew_ray.hpp"

namespace vam::optics {

void write_rays(std::ostream& out, const model::Printer& printer, const Detector& detector, int row) {
  const View view = projector_view(printer);
  const double z_p_mm = model::z_mm(printer.projector, row);
  out << "column,row,x_p_mm,z_p_mm,x_v_mm,z_mm,climb,delta_deg,T\n";
  for (int c = 0; c < detector.columns; ++c) {
    const double x_p_mm = detector.x_mm(c);
    const SkewRay ray = skew_ray(view, x_p_mm, z_p_mm);
    out << c << ',' << row << ',' << format_number(x_p_mm, 10) << ',' << format_number(z_p_mm, 10);
    if (ray.hits) {
      for (const double value :
           {ray.offset_mm, ray.height_mm, ray.climb, ray.delta_rad * deg_per_rad, ray.transmittance}) {
        out << ',' << format_number(value, 10);
      }
      out << '\n';
    } else {
      out << ",,,,,\n";
    }
  }
}

}  // namespace vam::optics
