// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/place.hpp"

#include "base/error.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "light/grids/dose_grid.hpp"
#include "light/grids/lit_grid.hpp"
#include "light/grids/poses.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/light_width.hpp"
#include "optics/writable_radius.hpp"
#include "session/dose_score.hpp"
#include "session/volumes.hpp"

namespace vam::dose_tool {

model::StackInfo posed(const cli::App& app, model::StackInfo info, const Options& options) {
  const std::string name = io::input_name(options.inputs.front());
  if (info.space != model::Space::projector) app.require_for("virtual sinograms", name);
  if (!options.poses.empty()) {
    info.poses = io::read_poses(options.poses);
    io::require_angles(options.poses, info.poses, info.height, info.angle_start_deg, info.angle_step_deg);
  }
  if (info.poses.empty()) return info;
  app.require_for("sinograms with poses", name);
  if (!model::repeat(info.poses)) app.require_for("poses that do not return", name);
  return info;
}

namespace {

/// A part whose coverage is judged; of a dose only the place of its voxels is known.
const io::SparseVolume* part_of(const io::SparseVolume& target, const Options& options) {
  if (target.units == "relative") return &target;
  if (!options.exposure_plan) return nullptr;
  throw Error{Fault::data, options.like +
                               ": grid 'target' is a dose for every voxel, not a part; --exposure-plan "
                               "requires the coverage of a part (vam-slice writes it)"};
}

}  // namespace

Place place_of(const Options& options, const model::Printer& printer, const model::StackInfo& info) {
  Place place;
  if (options.like.empty()) {
    place.grid = light::dose_grid(printer, info, options.size_mm);
    return place;
  }
  place.grids = session::read_like(options.like);
  io::SparseVolume* insert = session::find_grid(place.grids, "insert");
  io::SparseVolume& like = session::target_or_first(place.grids);
  place.like = &like;
  place.insert = insert;
  if (like.name() == "target") place.target = part_of(like, options);
  if (options.exposure_plan && place.target == nullptr) {
    throw Error{Fault::data,
                options.like + ": has no grid 'target'; --exposure-plan requires the part (vam-slice writes it)"};
  }
  const bool part = like.name() == "target";
  place.judged_mm = part ? session::judged_radius_mm(like, printer, info.extra) : optics::judged_radius_mm(printer, 0);
  light::require_in_reach(info.poses, printer, place.judged_mm);
  place.grid = like.grid();
  // What prints around the part must be seen.
  if (info.space == model::Space::projector) {
    place.grid = light::extended(place.grid, light::lit_margin(printer, place.grid, place.judged_mm, info.poses));
  } else if (info.extra.contains("vam:judged_radius_mm")) {
    place.grid = light::extended(place.grid, light::round_margin(place.grid, place.judged_mm));
  }
  like.extend_to(place.grid, options.like);
  if (insert != nullptr) insert->extend_to(place.grid, options.like);
  return place;
}

io::SparseVolume empty_volume(const cli::App& app, const Place& place, const model::Printer& printer,
                              const model::StackInfo& info, const Options& options) {
  io::SparseVolume volume("dose", place.grid);
  volume.metadata = info.extra;
  if (place.like != nullptr) volume.metadata.insert(place.like->metadata.begin(), place.like->metadata.end());
  volume.metadata["vam:printer"] = io::printer_settings(printer);
  model::state_width(volume.metadata, model::light_width(printer, info.angle_step_deg,
                                                         options.in_plane || info.space != model::Space::projector));
  volume.history = info.history;
  volume.history.push_back(app.history());
  return volume;
}

}  // namespace vam::dose_tool
