// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/ray_list.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "base/constants.hpp"
#include "base/text/text.hpp"
#include "model/magnification.hpp"
#include "model/rows.hpp"
#include "optics/skew_ray.hpp"
#include "optics/writable_radius.hpp"

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

double crossed_slices(const model::Printer& printer, const model::StackInfo& info) {
  const View view = projector_view(printer);
  if (!view.rows_lens_mm) return 0;
  const double magnification = model::vertical_magnification(printer);
  const double pitch_mm = info.row_mm > 0 ? info.row_mm : info.pixel_mm;
  const double radius_mm = reach_mm(view);
  const double lowest_mm = model::z_mm(printer.projector, printer.projector.rows - 1);
  const double highest_mm = model::z_mm(printer.projector, 0);
  double most = 0;
  for (const int slice : {0, info.count - 1}) {
    const double z_p_mm = std::clamp(info.z_start_mm + slice * pitch_mm, lowest_mm, highest_mm);
    const SkewRay ray = skew_ray(view, 0, z_p_mm);
    for (const double u_mm : {-radius_mm, radius_mm}) {
      most = std::max(most, std::abs(ray.z_mm(u_mm) - magnification * z_p_mm) / (magnification * pitch_mm));
    }
  }
  return most;
}

}  // namespace vam::optics
