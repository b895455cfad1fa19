// vam-optimize: projections that print a target.
#include <optional>
#include <string>

#include "base/log.hpp"
#include "base/text.hpp"
#include "device/interrupt.hpp"
#include "io/report.hpp"
#include "io/response_file.hpp"
#include "io/stream.hpp"
#include "optimize/quantise.hpp"
#include "optimize/volume.hpp"
#include "printer.hpp"
#include "vam-optimize/checkpoint.hpp"
#include "vam-optimize/inputs.hpp"
#include "vam-optimize/light.hpp"
#include "vam-optimize/options.hpp"

namespace {

using namespace vam;
using optimize_tool::Options;
using optimize_tool::Scene;

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

optimize::VolumeSource make_source(const optimize_tool::Inputs& in, const Options& options) {
  const auto reader = [](const std::vector<io::SparseVolume>& volumes) -> optimize::VolumeSource::Read {
    if (volumes.empty()) return {};
    return [&volume = volumes.front()](int k, int count, float* to) { volume.read_slices(k, count, to); };
  };
  return {in.grid().nz,      reader(in.target),    reader(in.insert),
          reader(in.weight), reader(in.tolerance), options.tolerance_mm / in.grid().voxel_mm};
}

/// What is to be done, without the way of the results.
optimize::VolumeTask make_task(const Scene& scene, const optimize_tool::Inputs& in, const Options& options) {
  optimize::VolumeTask task;
  task.source = make_source(in, options);
  task.circle = scene.circle;
  task.demands = options.demands;
  task.limits = options.limits;
  task.max_light = options.how.peak;
  task.blur_px = blur_px(scene, options);
  task.watch = !options.trace.empty();
  task.make = [&] { return optimize::make_method(options.method, options.how); };
  task.around = [&](std::span<const optimize::Slab> inserts) { return make_light(scene, options, inserts); };
  return task;
}

/// Where finished slices go: through the projector's grey levels if asked, into the stack.
class Sink {
 public:
  Sink(const Options& options, const model::Printer& printer, const model::StackInfo& info)
      : out_(options.output, info, options.stack), progress_("optimising", info.count) {
    if (!options.bits) return;
    const auto& file = printer.projector.response;
    const auto response =
        file.empty() ? resin::projector_response(printer.projector) : resin::Response(io::read_response(file));
    levels_.emplace(resin::GreyLevels(response, *options.bits), options.peak, options.error_feedback,
                    [this](const Image& image) { out_.write(image); });
  }
  void add(const Image& image) {
    if (levels_) {
      levels_->add(image);
    } else {
      out_.write(image);
    }
    progress_.tick();
  }
  void finish() {
    if (levels_) levels_->finish();
  }
  void commit() { out_.commit(); }

 private:
  io::StackWriter out_;
  std::optional<optimize::Quantiser> levels_;
  Progress progress_;
};

/// What there is to tell: dark voxels, the trace, the report.
void tell(const optimize::VolumeOutcome& outcome, const Options& options) {
  if (outcome.dark_part_voxels > 0) {
    warn(options.input + ": no light reaches " + std::to_string(outcome.dark_part_voxels) +
         " voxels of the part behind the insert; they will not print");
  }
  if (!options.trace.empty()) io::write_text(options.trace, optimize::trace_csv(outcome.trace));
  Json report = optimize::report(outcome);
  report["method"] = options.method;
  report["threshold_dose"] = options.demands.window.threshold();
  io::write_report(options.report, "vam-optimize/1", report);
}

void refuse_same_files(const Options& options) {
  for (const auto* input : {&options.input, &options.init, &options.weights, &options.tolerances}) {
    if (!input->empty()) io::refuse_same_file(*input, options.output);
  }
}

/// Options -> volumes -> light and task -> one pass after the other -> stack.
void run(const cli::App& app, Options& options) {
  settle(app, options);
  const model::Printer printer = tool::load_printer(options.printer);
  if (tool::print_printer(options.printer, printer, options.output)) return;
  refuse_same_files(options);
  settle_response(app, options);

  const optimize_tool::Inputs in = optimize_tool::read(options);
  const Scene scene = make_scene(in.grid(), printer, options);
  const model::StackInfo info = stack_info(scene, in.target.front(), app, options);
  optimize::VolumeTask task = make_task(scene, in, options);
  std::optional<optimize_tool::Initial> initial;
  if (!options.init.empty()) {
    initial.emplace(options.init, info);
    task.initial = [&](int k) { return (*initial)(k); };
  }
  std::optional<optimize_tool::Checkpoint> checkpoint;
  if (!options.checkpoint.empty()) {
    checkpoint.emplace(options.checkpoint);
    task.interruption = checkpoint->interruption(job(options, io::printer_toml(printer)));
  }
  Sink sink(options, printer, info);
  task.write = [&](int, const Image& image) { sink.add(image); };

  const auto outcome = optimize::optimise(task, *make_light(scene, options));
  if (outcome.reason == "interrupted") {
    checkpoint->keep();
    return;
  }
  sink.finish();
  tell(outcome, options);
  sink.commit();
  if (checkpoint) checkpoint->remove();
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(optimize_tool::manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] {
    if (options.checkpoint.empty()) return run(app, options);
    device::interruptible([&] { run(app, options); });  // ends by the signal, if one came
  });
}
