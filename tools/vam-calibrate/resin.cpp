// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate resin: the scattered intensity at which the resin gels, from the volume of a printed standard.
#include <optional>
#include <string>

#include "base/text/json.hpp"
#include "io/image/view_source.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/vdb/vdb.hpp"
#include "metrology/cure/threshold.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

struct ResinOptions {
  std::string scatter = "-";
  std::string record = "-";
  std::string profile;
  std::optional<double> diameter_mm;
  double profile_pixel_mm = 0.05;
};

void declare(cli::App& app, ResinOptions& options) {
  app.positional("SCATTER", options.scatter, "Scattering volume of the standard (VDB).").reads();
  app.option("-o,--output", "FILE.json", options.record, "Record for --resin; - is standard output.");
  app.option("--diameter", "MM", options.diameter_mm, cli::positive, "Known diameter of the standard.")
      .required_without("--profile");
  app.option("--profile", "FILE.png", options.profile,
             "Height image of the standard from a profilometer, to measure its diameter.")
      .reads()
      .form()
      .excludes({"--diameter"});
  app.option("--profile-pixel", "MM", options.profile_pixel_mm, cli::positive, "Pixel pitch of the height image.")
      .only_with({"--profile"});
}

void run(const cli::App& /*app*/, ResinOptions& options) {
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

}  // namespace

void add_resin(cli::App& app) {
  app.subcommand<ResinOptions>("resin", "gelation threshold, from a printed standard cylinder", declare, run);
}

}  // namespace vam::calibrate_tool
