// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate resin: the scattered intensity at which the resin gels, from the volume of a printed standard.
#include "base/text/json.hpp"
#include "io/image/view_source.hpp"
#include "io/settings/report.hpp"
#include "io/vdb/vdb.hpp"
#include "metrology/cure/threshold.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

void measure_resin(const ResinOptions& options) {
  double diameter_mm = options.diameter_mm.value_or(0);
  if (!options.profile.empty()) {
    diameter_mm = 2 * options.profile_pixel_mm * metrology::find_circle(io::read_field(options.profile)).radius;
  }
  const model::Volume volume = io::dense_volume(io::read_volume(options.scatter, ""));
  const metrology::OverheadMean overhead = metrology::overhead_mean(volume);
  Json figures = metrology::to_json(metrology::gelation_threshold(overhead.mean, volume.grid.voxel_mm, diameter_mm));
  figures["height_mm"] = overhead.height_mm;
  io::write_report(options.record, "vam-resin", figures);
}

}  // namespace vam::calibrate_tool
