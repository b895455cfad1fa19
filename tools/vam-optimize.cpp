// SPDX-License-Identifier: GPL-3.0-or-later
// vam-optimize: optimises the projections that print a target.
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/compute/aligned_memory.hpp"
#include "base/compute/memory.hpp"
#include "base/compute/per_slice.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "device/os/interrupt.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "model/grid_size.hpp"
#include "optimize/methods/method.hpp"
#include "optimize/run/printable.hpp"
#include "optimize/run/volume.hpp"
#include "session/dose_score.hpp"
#include "session/exposure.hpp"
#include "session/job_volumes.hpp"
#include "session/printer.hpp"
#include "session/scene.hpp"
#include "vam-optimize/exposure.hpp"
#include "vam-optimize/options.hpp"
#include "vam-optimize/publish.hpp"
#include "vam-optimize/sink.hpp"
#include "vam-optimize/starting_point.hpp"
#include "vam-optimize/task.hpp"

namespace {

using namespace vam;
using optimize_tool::Options;

/// Three slices (four with --delivered) and four sinograms for each slice (five where the best light is kept, six with
/// --robust) and what the method has beside, of all slices where they are one pass; and images on their way out. Those
/// are not kept in scratch files.
void require_memory_for(const session::Scene& scene, const optimize::VolumeTask& task, const light::Operator& light,
                        const optimize::MethodEntry& method, const std::string& subject) {
  const bool robust = task.scenarios != nullptr;
  const bool whole = optimize::takes_whole(task, light);
  const int count = whole ? scene.grid.nz : std::min(scene.grid.nz, slices_per_pass);
  const int slices = (count + lanes - 1) / lanes * lanes;
  const auto pixels = [](light::Shape shape) { return static_cast<double>(shape.width) * shape.height; };
  const double slice_arrays = (task.source.delivered ? 4 : 3) + method.more_slices;
  const double sinograms = (robust ? 6 : task.limits.patience > 0 ? 5 : 4) + method.more_sinograms;
  const double arrays = slice_arrays * pixels(light.object()) + sinograms * pixels(light.sinogram());
  const double images = sizeof(float) * pixels(light.image()) * 3 * std::min(lanes, count);
  const double bytes = sizeof(float) * slices * arrays + images;
  const std::string what = subject + ": " + model::size_text(scene.grid);
  require_memory(whole ? images : bytes, what, "use larger voxels (vam-slice --voxel) or fewer --angles");
  if (!whole) return;
  warn_of_scratch_files(bytes, what);
  keep_free(images);
}

/// Options -> volumes -> light and task -> one pass after the other -> stack.
void run(const cli::App& app, Options& options) {
  model::Printer printer = session::load_printer(options.printer);
  if (session::print_printer(options.printer, printer, options.output)) return;
  session::require_settings(app, printer);
  resolve(app, printer, options);
  printer.projector.axis_column += options.column_offset_px;
  resolve_recorded(printer, options);
  resolve_response(app, options);
  resolve_angles(app, options);

  const session::JobVolumes in = session::read(options);
  const session::Scene scene = session::make_scene(in.target.front(), printer, options);
  if (!model::repeat(scene.poses)) app.require_for("poses that do not return", io::input_name(options.input));
  session::warn_of(scene, in.target.front(), options);
  const model::StackInfo whole = stack_info(scene, in.target.front(), app, options);
  const std::optional<model::ImageRange> slices = slices_of(whole, options);
  model::StackInfo info = written_info(whole, slices, app, options);
  const bool planned = states_exposure(info, printer, options);
  if (planned) session::state_exposure(info.extra, 0, 0);  // until it is known
  options.stack.late = planned;
  optimize::VolumeTask task = make_task(scene, in, options);
  task.slices = slices;
  const auto light = session::make_light(scene, options);
  optimize_tool::require_independent(task, *light);
  std::optional<optimize_tool::Initial> initial;
  std::optional<optimize_tool::Checkpoint> checkpoint;
  if (!options.init.empty()) initial.emplace(options.init, whole);
  if (!options.checkpoint.empty()) checkpoint.emplace(app, printer, options);
  optimize_tool::Sink sink(options, printer, info);
  task.write = [&](int k, const Image& image) {
    if (k < whole.count) sink.add(image);  // there may be more slices than rows
  };

  const std::string subject = io::input_name(options.input);
  require_memory_for(scene, task, *light, optimize::method_entry(options.method), subject);
  if (!options.demands.grey) task.unresolved = session::unresolved(in.target.front());
  optimize::require_printable(task, {scene.grid.nx, scene.grid.ny}, subject);
  if (initial) task.initial = std::ref(*initial);
  if (checkpoint) task.checkpoint = checkpoint->state();
  auto outcome = optimize::optimise(task, *light);
  if (outcome.stop == optimize::StopReason::interrupted) {
    checkpoint->keep();  // without one nothing interrupts
    note("vam-optimize: interrupted; " + options.checkpoint + " has its state, from which the same command resumes");
    return;
  }
  const bool void_piece = slices && outcome.metrics.part == 0;
  if (!options.demands.grey && !void_piece) optimize::require_light(outcome, subject, task.source.band_px);
  const auto printing = judge_printed(task, *light, sink, scene, info, options, outcome);
  const verdict::Verdict verdict = verdict_of(task, outcome, printing, scene, in.target.front(), info, options);
  std::optional<optimize::Trials> trials;
  if (options.printer_tolerances || options.tolerances) {
    trials = run_trials(make_trial(scene, printing.seconds, printing.threshold.dose, !verdict.fails(), options), task,
                        sink.kept());
  }
  if (planned && printing.plan) {
    session::state_exposure(info.extra, printing.plan->turns, printing.full_scale);
    sink.state(info.extra);
  }
  sink.commit();  // hours of work, which no figure or report shall undo
  publish(task, outcome, printing, verdict, trials, scene, in.target.front(), info, options);
  if (checkpoint) checkpoint->remove();
}

/// A paragraph for each row of the method table.
std::vector<std::string> method_texts() {
  std::vector<std::string> texts;
  for (const auto& entry : optimize::method_table()) texts.push_back(entry.name + ": " + entry.summary);
  return texts;
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-optimize",
                "optimise the projections that print a part",
                manual_page,
                {{130, "SIGINT; with --checkpoint the run can be resumed."}, {143, "SIGTERM; likewise."}},
                false,
                {cli::ManualList{"methods", method_texts()}}});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] {
    if (options.checkpoint.empty()) return run(app, options);
    device::interruptible([&] { run(app, options); });  // ends by the signal, if one came
  });
}
