#include "metrology/ost/threshold.hpp"

#include "base/error.hpp"
#include "base/json.hpp"
#include "io/settings/report.hpp"
#include "vam-ost/session.hpp"

namespace vam::ost_tool {

void threshold(const Options& options) {
  if (options.diameter_mm.has_value() == !options.profile.empty()) {
    throw Error{Fault::usage, "threshold: give the size of the standard by either --diameter or --profile"};
  }
  double diameter_mm = options.diameter_mm.value_or(0);
  if (!options.profile.empty())
    diameter_mm = 2 * options.profile_pixel_mm * metrology::find_circle(io::read_field(options.profile)).radius;
  const model::Volume volume = dense(io::read_volume(options.scatter, ""));
  const metrology::OverheadMean overhead = metrology::overhead_mean(volume);
  Json figures = metrology::to_json(metrology::gelation_threshold(overhead.mean, volume.grid.voxel_mm, diameter_mm));
  figures["height_mm"] = overhead.height_mm;
  io::write_report(options.record, "vam-resin/1", figures);
}

}  // namespace vam::ost_tool
