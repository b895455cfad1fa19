// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/publish.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/compute/slab.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_fwd.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "light/grids/blurred_faces.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/light_width.hpp"
#include "model/magnification.hpp"
#include "model/metadata.hpp"
#include "model/rows.hpp"
#include "optimize/run/limited_by.hpp"
#include "session/exposure.hpp"
#include "session/volumes.hpp"
#include "vam-optimize/front.hpp"

namespace vam::optimize_tool {

namespace {

// Level faces that rays that climb cannot print sharply.

std::vector<light::FlatFace> faces_of(const io::SparseVolume& target) {
  const model::Grid& grid = target.grid();
  light::FlatFaceFinder finder(grid);
  std::vector<float> slice(grid.slice_size());
  for (int k = 0; k < grid.nz; ++k) {
    target.read_slices(k, 1, slice.data());
    finder.add(1, slice.data());
  }
  return finder.faces();
}

/// The part's middle and how far it may be lifted from where it is.
struct LiftLimits {
  double middle_mm, least_mm, most_mm;
};

LiftLimits lift_limits(const io::SparseVolume& target, const model::Projector& projector) {
  const model::VoxelBox box = io::covered_box(target, model::coverage_rounding);
  const double low_mm = target.grid().z_mm(box.low[2] - 0.5);
  const double high_mm = target.grid().z_mm(box.high[2] + 0.5);
  return {0.5 * (low_mm + high_mm), std::min(0.0, model::z_mm(projector, projector.rows - 0.5) - low_mm),
          std::max(0.0, model::z_mm(projector, -0.5) - high_mm)};
}

void warn_of(const std::vector<light::BlurredFace>& hard, const light::FaceRemedy& remedy, double place_mm,
             double scale, const std::string& input) {
  const auto& worst = *std::max_element(hard.begin(), hard.end(),
                                        [](const auto& a, const auto& b) { return a.blur_voxels < b.blur_voxels; });
  const std::string lift = remedy.blur_voxels < 0.9 * worst.blur_voxels
                               ? "vam-slice --place " + format_number(place_mm, 3) + " reduces this to " +
                                     format_number(remedy.blur_voxels, 2) + ", "
                               : "";
  warn(input + ": climbing rays blur " + std::to_string(hard.size()) + " horizontal face" +
       (hard.size() > 1 ? "s" : "") + " of the part, most severely the " + (worst.face.up ? "upper" : "lower") +
       " face at z = " + format_number(scale * worst.face.z_mm, 4) + " mm, " + format_number(worst.face.width_mm, 3) +
       " mm wide, over " + format_number(worst.blur_voxels, 2) + " voxels (" + std::to_string(worst.wrong_voxels) +
       " wrong voxels); " + lift + "--rotate " + format_number(remedy.tilt_deg) +
       ",0,0 tilts the faces out of the rays");
}

/// The field blurred_faces of the report, and a warning where there are any. Nothing where rays stay level or the part
/// moves.
void add_blurred_faces(Json& report, const optimize::VolumeOutcome& outcome, const session::Scene& scene,
                       const io::SparseVolume& target, const Options& options) {
  if (outcome.wrong.empty() || !scene.poses.empty()) return;
  const double scale = model::vertical_magnification(scene.printer);
  const double voxel_mm = scene.grid.voxel_mm;
  report["blurred_faces"] = Json::array();
  if (std::all_of(outcome.wrong.begin(), outcome.wrong.end(), [](auto n) { return n == 0; })) return;
  const std::vector<light::FlatFace> faces = faces_of(target);
  const auto hard = light::blurred_faces(scene.printer, scene.grid, outcome.wrong, faces);
  if (hard.empty()) return;
  const LiftLimits limits = lift_limits(target, scene.printer.projector);
  const auto remedy = light::face_remedy(scene.printer, faces, hard, voxel_mm, limits.least_mm, limits.most_mm);
  for (const light::BlurredFace& one : hard) {
    report["blurred_faces"].push_back({{"z_mm", scale * one.face.z_mm},
                                       {"faces", one.face.up ? "up" : "down"},
                                       {"width_mm", one.face.width_mm},
                                       {"area_mm2", one.face.area_mm2},
                                       {"blur_voxels", one.blur_voxels},
                                       {"wrong_voxels", one.wrong_voxels}});
  }
  const double place_mm = scale * (limits.middle_mm + remedy.lift_mm);
  report["blurred_faces_remedy"] = {
      {"place_mm", place_mm}, {"blur_voxels", remedy.blur_voxels}, {"tilt_deg", remedy.tilt_deg}};
  warn_of(hard, remedy, place_mm, scale, io::input_name(options.input));
}

/// What it took, and what twice of that would buy, by how the latitude grew last.
std::string what_more_buys(const optimize::VolumeOutcome& outcome) {
  if (!(outcome.growth >= 0.1 && outcome.growth < 1) || outcome.metrics.latitude <= 0) return "";
  const std::string twice = format_number(50 * outcome.metrics.latitude * std::exp2(outcome.growth), 2);
  return "; computed in " + format_number(outcome.seconds, 2) + " s, some +-" + twice + " % of dose would take " +
         format_number(2 * outcome.seconds, 2) + " s";
}

void warn_of(const optimize::VolumeOutcome& outcome, const verdict::Verdict& verdict, const Options& options) {
  session::warn_of_shadowed_voxels(options.input, outcome.dark_part_voxels);
  const model::DoseMetrics& m = outcome.metrics;
  const bool has_goal = !options.until.empty() || options.max_intensity || options.turns;
  if (!has_goal || !verdict.fails()) return;
  const bool by_time = outcome.stop == optimize::StopReason::time;
  const bool limited = outcome.max_intensity > 0 && outcome.peak_intensity > 0.98 * outcome.max_intensity;
  warn(io::input_name(options.input) + ": does not print " +
       (verdict.answer == verdict::Answer::no ? "" : "as designed ") + "after " + std::to_string(outcome.iterations) +
       (outcome.iterations == 1 ? " iteration" : " iterations") + (by_time ? " within --budget" : "") +
       ": voxel error rate " + format_number(m.ver, 2) + ", process window " + format_number(m.pw, 2) +
       (outcome.stop == optimize::StopReason::goal ? "; smaller voxels"
        : by_time                                  ? "; a larger --budget"
                                                   : "; more --iterations") +
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

verdict::Verdict verdict_of(const optimize::VolumeTask& task, const optimize::VolumeOutcome& outcome,
                            const Printing& printing, const session::Scene& scene, const io::SparseVolume& target,
                            const model::StackInfo& info, const Options& options) {
  if (options.demands.grey) return {.words = verdict::grey_words(outcome.metrics)};
  const model::Printer& printer = scene.printer;
  verdict::GivenPrint print = outcome.print(scene.grid, model::stretch_z(target.metadata),
                                            model::light_width(printer, info.angle_step_deg, !options.in_vial()));
  if (printing.plan) print.seconds = printing.plan->seconds;
  if (printing.threshold.best && print.pieces) print.best = printing.threshold.dose;
  print.threshold = printing.of_exposure;
  if (print.threshold && !fixed_threshold(options)) {  // the dose of a print, in mJ/cm3
    print.threshold = printer.resin.critical_dose_mj_cm3;
    for (double* dose : {&print.whole.min_part, &print.whole.max_void})
      *dose *= *print.threshold / *printing.of_exposure;
  }
  return verdict::judge(task.unresolved, print);
}

void publish(const optimize::VolumeTask& task, const optimize::VolumeOutcome& outcome, const Printing& printing,
             verdict::Verdict verdict, const std::optional<optimize::Trials>& trials, const session::Scene& scene,
             const io::SparseVolume& target, const model::StackInfo& info, const Options& options) {
  const model::Printer& printer = scene.printer;
  warn_of(outcome, verdict, options);
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
  if (printing.plan) append_json(report, *printing.plan);
  if (options.demands.grey) {  // no part and void, whose doses these would be
    for (const char* key : {"latitude", "threshold", "min_part", "max_part", "mean_part", "max_void", "max_dose"})
      report.erase(key);
    report["verdict"] = verdict.words;
    note("vam-optimize: " + io::input_name(options.input) + " " + verdict.words +
         "; vam-score --grey-target judges the dose");
  } else {
    report["print_threshold"] = printing.threshold.dose;
    if (options.tolerances) verdict.words += words_of_ends(*trials, !verdict.fails());
    append_json(report, verdict);
    const bool stated = options.in_vial() && info.piece.whole() && shown.planned;
    note("vam-optimize: " + io::input_name(options.input) + " " + verdict.words + what_more_buys(outcome) +
         session::how_to_show(printer.resin, stated, options.output == "-" ? "SINOGRAM" : options.output,
                              options.printer));
    report["limited_by"] = optimize::limited_by(
        outcome.demands, [&](int k) { return model::vertical_magnification(printer) * scene.grid.z_mm(k); });
    add_blurred_faces(report, outcome, scene, target, options);
  }
  if (trials) report["robust"] = optimize::report(*trials);
  io::write_report(options.report, "vam-optimize", report);
}

}  // namespace vam::optimize_tool
