// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/task.hpp"

#include <algorithm>

#include "base/compute/per_slice.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack_pieces.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/recorded_tolerances.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "vam-optimize/exposure.hpp"
#include "vam-optimize/front.hpp"

namespace vam::optimize_tool {

model::StackInfo stack_info(const session::Scene& scene, const io::SparseVolume& target, const cli::App& app,
                            const Options& options) {
  model::StackInfo info;
  info.width = scene.turn.columns;
  info.height = scene.frames();
  info.count = scene.poses.empty() ? scene.grid.nz : scene.rows;
  info.poses = scene.poses;
  info.pixel_mm = info.row_mm = scene.grid.voxel_mm;
  info.extra = target.metadata;
  model::Printer stated = scene.printer;  // frames know nothing of the offset
  stated.projector.axis_column -= options.column_offset_px;
  info.extra["vam:printer"] = io::printer_settings(stated);
  if (options.in_vial()) {
    info.space = model::Space::projector;
    info.width = scene.printer.projector.columns;
    info.pixel_mm = scene.printer.projector.pixel_mm;
  } else {
    info.extra["vam:judged_radius_mm"] = format_number(scene.circle.radius * scene.grid.voxel_mm, 9);
  }
  info.z_start_mm = scene.poses.empty() ? scene.grid.z_mm(0) : scene.first_row_mm;
  info.angle_step_deg = 360.0 / scene.turn.angles;
  info.units = "1/rad";
  info.history = target.history;
  info.history.push_back(app.history());
  info.extra["vam:threshold_dose"] = format_number(options.demands.window.threshold());
  if (options.demands.grey && options.response != "linear") info.extra["vam:response"] = options.response;
  return info;
}

std::optional<model::ImageRange> slices_of(const model::StackInfo& whole, const Options& options) {
  if (options.slices.empty()) return std::nullopt;
  return model::slices_among(options.slices, whole.count, io::input_name(options.input), slices_per_pass);
}

model::StackInfo written_info(const model::StackInfo& whole, const std::optional<model::ImageRange>& slices,
                              const cli::App& app, const Options& options) {
  if (!slices) return whole;
  model::StackInfo info = io::cut(whole, *slices, io::input_name(options.input));
  info.history.back() =
      app.history_without({"--slices", "--output", "--report", "--trace", "--checkpoint", "--threads"});
  return info;
}

void require_independent(const optimize::VolumeTask& task, const light::Operator& light) {
  if (!task.slices || !optimize::takes_whole(task, light)) return;
  throw Error{
      Fault::usage,
      light.couples_slices()
          ? "--slices: rays that climb, or spread along z, couple all slices, and light of a piece differs from that "
            "of "
            "the whole part by a tenth of the peak or more, however many slices around it are known; omit it, or use "
            "level rays (projector.telecentric without projector.half_angle_deg, or --geometry parallel)"
          : "--slices: the dose is blurred farther than 16 slices, so all are optimised together; omit it"};
}

namespace {

optimize::IntensityLimit limit(const session::Scene& scene, const Options& options) {
  if (!options.turns) return options.limit;
  constexpr double sure = 0.95;  // the middle of the window may lie a little below the threshold that was aimed at
  const double showings = *options.turns * scene.turn.angles / static_cast<double>(scene.frames());
  return {.most = sure * full_grey(scene.printer, showings, options), .of_even = 0};
}

}  // namespace

optimize::VolumeTask make_task(const session::Scene& scene, const session::JobVolumes& in, const Options& options) {
  optimize::VolumeTask task;
  task.source = session::source_of(in, scene, options);
  task.circle = scene.circle;
  task.part = light::moved(io::covered_box(in.target.front(), model::coverage_rounding), scene.margin);
  task.demands = options.demands;
  task.limits = options.limits;
  task.limit = limit(scene, options);
  task.raising = options.raising;
  task.blur_px = session::blur_px(scene.printer.resin, session::diffusion_s(scene, options), scene, options);
  task.watch = !options.trace.empty();
  task.make = [&](double max_intensity) {
    optimize::MethodOptions how = options.how;
    how.max_intensity = max_intensity;
    const optimize::MethodEntry& method = optimize::method_entry(options.method);
    return (options.printer_tolerances ? method.make_robust : method.make)(how);
  };
  task.around = [&](std::span<const Slab> inserts) { return session::make_light(scene, options, inserts); };
  task.certify = options.certify.empty() ? 0 : optimize::certify_iterations;
  if (!options.tradeoff.empty()) task.front = make_show(scene.printer, options);
  if (options.printer_tolerances) {
    task.scenarios = [&](std::span<const Slab> inserts) {
      return optimize::corner_scenarios(
          session::tolerant(scene, options, *options.printer_tolerances, session::diffusion_s(scene, options)),
          inserts);
    };
  }
  return task;
}

optimize::Trial make_trial(const session::Scene& scene, double seconds, double threshold, bool prints,
                           const Options& options) {
  optimize::Trial trial;
  trial.printer = session::tolerant(
      scene, options, options.printer_tolerances ? *options.printer_tolerances : io::expected_tolerances(scene.printer),
      seconds);
  trial.grid = scene.grid;
  trial.threshold = options.printer_tolerances ? options.demands.window.threshold() : threshold;
  trial.printers = options.printer_tolerances ? options.yield_printers : 0;
  trial.ends = options.tolerances && prints;
  return trial;
}

}  // namespace vam::optimize_tool
