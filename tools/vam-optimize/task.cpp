#include "vam-optimize/task.hpp"

#include "base/text.hpp"

namespace vam::optimize_tool {

model::StackInfo stack_info(const Scene& scene, const io::SparseVolume& target, const cli::App& app,
                            const Options& options) {
  model::StackInfo info;
  info.width = scene.turn.columns;
  info.height = scene.turn.angles;
  info.count = scene.grid.nz;
  info.pixel_mm = info.row_mm = scene.grid.voxel_mm;
  if (options.geometry == "vial") {
    info.space = model::Space::projector;
    info.width = scene.printer.projector.columns;
    info.pixel_mm = scene.printer.projector.pixel_mm;
  }
  info.z_start_mm = scene.grid.z_mm(0);
  info.angle_step_deg = 360.0 / scene.turn.angles;
  info.units = "1/rad";
  info.history = target.history;
  info.history.push_back(app.history());
  info.extra = target.metadata;
  info.extra["vam:threshold_dose"] = format_number(options.demands.window.threshold());
  return info;
}

namespace {

optimize::VolumeSource make_source(const Inputs& in, const Options& options) {
  const auto reader = [](const std::vector<io::SparseVolume>& volumes) -> optimize::VolumeSource::Read {
    if (volumes.empty()) return {};
    return [&volume = volumes.front()](int k, int count, float* to) { volume.read_slices(k, count, to); };
  };
  return {in.grid().nz,      reader(in.target),    reader(in.insert),
          reader(in.weight), reader(in.tolerance), options.tolerance_mm / in.grid().voxel_mm};
}

}  // namespace

optimize::VolumeTask make_task(const Scene& scene, const Inputs& in, const Options& options) {
  optimize::VolumeTask task;
  task.source = make_source(in, options);
  task.circle = scene.circle;
  task.demands = options.demands;
  task.limits = options.limits;
  task.max_intensity = options.how.max_intensity;
  task.blur_px = blur_px(scene, options);
  task.watch = !options.trace.empty();
  task.make = [&] { return optimize::make_method(options.method, options.how); };
  task.around = [&](std::span<const Slab> inserts) { return make_light(scene, options, inserts); };
  return task;
}

}  // namespace vam::optimize_tool
