// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/crossed_slices.hpp"

#include <algorithm>
#include <cmath>

#include "model/magnification.hpp"
#include "model/rows.hpp"
#include "optics/skew_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::optics {

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
