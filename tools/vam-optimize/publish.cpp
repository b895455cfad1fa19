// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/publish.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/compute/slab.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "model/light_width.hpp"
#include "model/magnification.hpp"
#include "model/metadata.hpp"
#include "optimize/run/limited_by.hpp"
#include "session/dose_score.hpp"
#include "session/exposure.hpp"
#include "session/volumes.hpp"
#include "vam-optimize/faces.hpp"
#include "vam-optimize/front.hpp"
#include "verdict/verdict.hpp"

namespace vam::optimize_tool {

namespace {

void warn_of(const optimize::VolumeOutcome& outcome, const Options& options) {
  session::warn_of_shadowed_voxels(options.input, outcome.dark_part_voxels);
  const model::DoseMetrics& m = outcome.metrics;
  const bool has_goal = !options.until.empty() || options.max_intensity || options.turns;
  if (!has_goal || outcome.stop == optimize::StopReason::goal || options.demands.grey || outcome.all_cut || m.ver == 0)
    return;
  const bool by_time = outcome.stop == optimize::StopReason::time;
  const bool limited = outcome.max_intensity > 0 && outcome.peak_intensity > 0.98 * outcome.max_intensity;
  warn(io::input_name(options.input) + ": does not print after " + std::to_string(outcome.iterations) +
       (outcome.iterations == 1 ? " iteration" : " iterations") + (by_time ? " within --budget" : "") +
       ": voxel error rate " + format_number(m.ver, 2) + ", process window " + format_number(m.pw, 2) +
       (by_time ? "; a larger --budget" : "; more --iterations") +
       (limited ? ", or a --max-intensity above " + format_number(outcome.max_intensity, 3) + "," : "") + " may help");
}

/// The weights of the proof, positive in the void, negative in the part, the largest 1 or -1.
void write_proof(const optimize::Certificate& proof, const session::Scene& scene, const io::SparseVolume& target,
                 const model::StackInfo& info, const std::string& path) {
  const model::Grid& grid = scene.grid;
  io::SparseVolume volume("certificate", grid);
  volume.metadata = target.metadata;
  volume.history = info.history;
  float most = 0;
  for (const Slab& slab : proof.weights) {
    for (const float weight : slab.values) most = std::max(most, std::abs(weight));
  }
  const float unit = most > 0 ? 1 / most : 1;
  std::vector<float> slices(grid.slice_size() * lanes);
  for (std::size_t s = 0; s < proof.weights.size(); ++s) {
    const int first = static_cast<int>(s) * lanes;
    const int count = std::min(lanes, grid.nz - first);
    if (count <= 0) break;
    unpack(proof.weights[s], count, slices.data());
    for (float& weight : slices) weight *= unit;
    volume.write_slices(first, count, slices.data());
  }
  io::write_volume(path, volume);
}

/// What was delivered: to the part, on average, and the void that has gelled by it, which no light can undo. Nothing
/// where none was.
void report_delivered(Json& report, const optimize::VolumeSource& source, const session::Scene& scene,
                      const Options& options) {
  if (!source.delivered) return;
  const double threshold = options.demands.window.threshold();
  double part_dose = 0;
  std::int64_t part = 0, gelled = 0;
  std::vector<float> dose(scene.grid.slice_size()), target(dose.size());
  for (int k = 0; k < scene.grid.nz; ++k) {
    source.delivered(k, 1, dose.data());
    source.target(k, 1, target.data());
    for (std::size_t i = 0; i < dose.size(); ++i) {
      const model::Label label = model::label_of(target[i]);
      const auto received = static_cast<double>(dose[i]);
      if (label == model::Label::part) {
        part_dose += received;
        ++part;
      }
      if (label == model::Label::void_ && received >= threshold) ++gelled;
    }
  }
  const double percent = part > 0 ? 100 * part_dose / (static_cast<double>(part) * threshold) : 0;
  report["delivered"] = {{"part_mean_percent", percent}, {"void_gelled_voxels", gelled}};
  if (gelled == 0) return;
  warn(join(options.delivered, ", ") + ": " + std::to_string(gelled) +
       (gelled == 1 ? " voxel of the void has" : " voxels of the void have") +
       " received the critical dose already, which no light can undo; stop earlier, or with less light");
}

}  // namespace

void publish(const optimize::VolumeTask& task, const optimize::VolumeOutcome& outcome,
             const std::optional<optimize::Trials>& trials, const session::Scene& scene, const io::SparseVolume& target,
             const std::optional<score::ExposurePlan>& plan, std::optional<double> threshold,
             const model::StackInfo& info, const Options& options) {
  const model::Printer& printer = scene.printer;
  warn_of(outcome, options);
  if (!options.trace.empty()) io::write_text(options.trace, optimize::trace_csv(outcome.trace));
  if (!options.tradeoff.empty()) write_front(options.tradeoff, outcome.front, printer, info, options);
  if (outcome.certificate) write_proof(*outcome.certificate, scene, target, info, options.certify);
  Json report = optimize::report(outcome);
  report["method"] = options.method;
  report["judged_radius_mm"] = scene.circle.radius * scene.grid.voxel_mm;
  report["threshold_dose"] = options.demands.window.threshold();
  if (outcome.surface) {
    const double voxel_mm = scene.grid.voxel_mm;
    report["surface"] = {{"mean_mm", outcome.surface->mean * voxel_mm}, {"rms_mm", outcome.surface->rms * voxel_mm}};
  }
  report_delivered(report, task.source, scene, options);
  const session::Exposure shown = session::exposure_of(options.output, info, printer, 0);
  if (shown.full_scale > 0) report["full_scale"] = shown.full_scale;
  if (plan) add_to(report, *plan);
  if (options.demands.grey) {  // no part and void, whose doses these would be
    for (const char* key : {"threshold", "min_part", "max_part", "mean_part", "max_void", "max_dose"})
      report.erase(key);
    report["verdict"] = verdict::grey_words(outcome.metrics);
    note("vam-optimize: " + io::input_name(options.input) + " " + verdict::grey_words(outcome.metrics) +
         "; vam-score --grey-target judges the dose");
  } else {
    verdict::GivenPrint print = outcome.print(scene.grid, model::stretch_z(target.metadata),
                                              model::light_width(printer, info.angle_step_deg, !options.in_vial()));
    if (plan) print.seconds = plan->seconds;
    print.threshold = threshold;
    const verdict::Verdict verdict = verdict::judge(session::unresolved(target), print);
    add_to(report, verdict);
    const bool stated = options.in_vial() && info.piece.whole() && shown.planned;
    note("vam-optimize: " + io::input_name(options.input) + " " + verdict.words +
         session::how_to_show(printer.resin, stated, options.output == "-" ? "SINOGRAM" : options.output,
                              options.printer));
    report["limited_by"] = optimize::limited_by(
        outcome.demands, [&](int k) { return model::vertical_magnification(printer) * scene.grid.z_mm(k); });
    add_blurred_faces(report, outcome, scene, target, options);
  }
  if (trials) report["robust"] = optimize::report(*trials, *options.printer_tolerances);
  io::write_report(options.report, "vam-optimize", report);
}

}  // namespace vam::optimize_tool
