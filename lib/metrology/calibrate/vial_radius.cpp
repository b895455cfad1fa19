// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/vial_radius.hpp"

#include "optics/chief_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::metrology {

double vial_radius_mm(const model::Printer& printer, double edge_px) {
  const optics::View view = optics::projector_view(printer);
  const double impact = optics::impact_mm(view, edge_px * printer.projector.pixel_mm);
  if (optics::grazing_impact_mm(view) >= view.shells.front().radius_mm * (1 - 1e-12)) return impact;
  return impact * optics::resin_radius_mm(view) / optics::grazing_impact_mm(view) + printer.vial.wall_mm;
}

}  // namespace vam::metrology
