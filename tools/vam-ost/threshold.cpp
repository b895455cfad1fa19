#include "metrology/threshold.hpp"

#include "base/error.hpp"
#include "io/report.hpp"
#include "vam-ost/session.hpp"

namespace vam::ost_tool {

void threshold(const Options& options) {
  if (options.diameter_mm.has_value() == !options.profile.empty()) {
    throw Error{Fault::usage, "threshold: give the standard's size, either --diameter or --profile"};
  }
  double diameter_mm = options.diameter_mm.value_or(0);
  if (!options.profile.empty())
    diameter_mm = 2 * options.profile_pixel_mm * metrology::find_circle(io::read_field(options.profile)).radius;
  const model::Volume volume = dense(io::read_volume(options.scatter, ""));
  Image overhead = metrology::sum_projections(volume).along_z;
  const auto height_mm = static_cast<float>(volume.grid.nz * volume.grid.voxel_mm);
  for (float& value : overhead.values) value /= height_mm;
  Json figures = metrology::to_json(metrology::gelation_threshold(overhead, volume.grid.voxel_mm, diameter_mm));
  io::write_report(options.record, "vam-resin/1", figures);
}

}  // namespace vam::ost_tool
