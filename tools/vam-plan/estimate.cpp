// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-plan/estimate.hpp"

#include <algorithm>
#include <cmath>

#include "base/text/text.hpp"
#include "io/settings/recorded_tolerances.hpp"
#include "model/dose/dose_spread.hpp"
#include "model/dose/stray_cure.hpp"
#include "model/light_width.hpp"
#include "optics/writable_radius.hpp"
#include "optimize/run/preview.hpp"
#include "resin/absolute_dose.hpp"
#include "solid/voxel/size_doubt.hpp"

namespace vam::plan_tool {

namespace {

constexpr auto axis = static_cast<std::size_t>(model::ToleranceKind::axis);
constexpr int usual_coarseness = 4;
constexpr double most_coarse_voxels = 2e6;   // of the part, on the coarsest voxels
constexpr double most_finer_voxels = 0.7e6;  // on those that are taken where coarser ones do not tell
constexpr double sure_window = 0.03;         // of the largest dose: what finer voxels and more iterations may cost
constexpr double hopeless = -0.1;            // a window that neither will open

bool is_lost(const verdict::SubVoxelFeatures& some) { return some.loses_walls() || some.bridges_gaps(); }

/// The part on voxels of some size, and the bench with pixels as large.
struct Level {
  model::Printer printer;
  Filled part;
  int coarseness = 1;  // of the print's voxels, for one of these

  [[nodiscard]] const verdict::SubVoxelFeatures& unresolved() const { return part.content.unresolved; }
  [[nodiscard]] double voxel_mm() const { return part.volume.grid.voxel_mm; }
  [[nodiscard]] bool is_final() const { return coarseness == 1; }
  [[nodiscard]] bool is_judged() const { return part.content.solid_voxels > 0; }
  /// Whether walls and gaps are as thick as the voxels, by their coverage and by the part's own surface: hardly any is
  /// lost, little is not resolved.
  [[nodiscard]] bool shows_all() const {
    constexpr double most_lost = 0.001;
    const verdict::SubVoxelFeatures& un = unresolved();
    return is_judged() && !un.leaves_doubt() && !un.is_much() &&
           un.lost_walls.voxels + un.lost_gaps.voxels <= most_lost * un.whole;
  }
};

Level level_of(const EstimateTask& task, int coarseness) {
  constexpr double rounding = 1e-9;
  Level level{task.printer, filled(task.part, coarseness * task.grid.voxel_mm), coarseness};
  while (2 * level.printer.projector.pixel_mm < (1 + rounding) * level.voxel_mm())
    level.printer = model::coarser(level.printer);
  return level;
}

const double light_threshold = optimize::DoseWindow{}.threshold();

std::optional<score::ExposurePlan> exposure_of(const optimize::VolumeOutcome& outcome, const model::Printer& printer) {
  const auto per_radian = resin::dose_per_radian_mj_cm3(printer);
  if (!per_radian || outcome.peak_intensity <= 0 || verdict::window_middle(outcome.metrics) <= 0) return std::nullopt;
  return score::plan_exposure(outcome.metrics, *per_radian / outcome.peak_intensity, printer, 1, light_threshold);
}

optimize::Preview preview_of(const Level& level, const model::Printer& printer) {
  optimize::PreviewTask task;
  task.expose = [&](const optimize::VolumeOutcome& outcome) {
    const auto exposure = exposure_of(outcome, printer);
    return optimize::Exposed{verdict::print_threshold(outcome.metrics, std::nullopt, light_threshold).dose,
                             exposure ? exposure->seconds : model::seconds_of(printer.stage, printer.stage.turns)};
  };
  task.printer = level.printer;
  task.part = model::covered_box(level.part.volume, model::coverage_rounding);
  task.radius_mm = optics::judged_radius_mm(task.printer, level.part.content.radius_mm);
  task.target = level.part.volume;
  task.tolerances = io::expected_tolerances(printer);
  task.tolerances[axis] *=  // of the printer's pixels
      printer.projector.pixel_mm / level.printer.projector.pixel_mm;
  return optimize::preview(task);
}

/// What the voxels of the print lose is lost whatever these show.
verdict::Verdict verdict_of(const Level& level, const EstimateTask& task, const optimize::Preview& preview,
                            const optimize::VolumeOutcome& outcome) {
  const model::LightWidth light = model::light_width(level.printer, 360.0 / optimize::PreviewTask{}.print_angles);
  return verdict::judge(is_lost(task.unresolved) ? task.unresolved : level.unresolved(),
                        outcome.print(preview.grid, task.stretch_z, light));
}

/// Why these voxels need not show all of the part: walls, gaps, edges or necks that are finer. Empty: they do.
std::string hidden(const Level& level, const EstimateTask& task) {
  if (level.is_final()) return "";
  if (!level.shows_all()) return "walls or gaps are too thin for these voxels";
  if (task.sharp_edges) return "edges taper to less than 3 voxels of the print";
  if (task.thinnest_voxels < model::narrow_voxels * level.coarseness)
    return "the thinnest place, of " + format_number(task.thinnest_voxels * task.grid.voxel_mm, 2) +
           " mm, is less than two of these voxels";
  return "";
}

/// What the print of these voxels shows of that of the final ones, or why it does not.
struct Told {
  std::optional<bool> prints;
  std::string why_not{};
};
Told prints(const Level& level, const verdict::Verdict& verdict, const EstimateTask& task) {
  const verdict::SubVoxelFeatures& final = task.unresolved;
  const std::string fine = hidden(level, task);
  if (final.leaves_doubt() && verdict.answer >= verdict::Answer::unsure)
    return {{}, "walls or gaps are too thin for the voxels of the print"};
  switch (verdict.answer) {
    case verdict::Answer::no:
      if (level.is_final() || is_lost(final)) return {false};
      if (fine.empty() && verdict.print.whole.pw < hopeless) return {false};
      return {{}, fine.empty() ? "smaller voxels may open a window that is so little negative" : fine};
    case verdict::Answer::not_as_designed:
      if (level.is_final() || is_lost(final)) return {false};
      return {{}, "what is cut or joined on these voxels may be whole on smaller ones"};
    case verdict::Answer::yes:
      if (!fine.empty()) return {{}, fine};
      if (verdict.print.whole.pw >= sure_window) return {true};
      return {{}, "the process window is narrower than " + format_number(sure_window)};
    case verdict::Answer::not_judged:
    case verdict::Answer::unsure:
    case verdict::Answer::left_open:
      break;
  }
  return {{}, "pieces or holes of the print are in doubt"};
}

/// What tells where an estimate does not.
std::string told_by(const Level& level, const verdict::Verdict& verdict, const EstimateTask& task) {
  const auto voxel = [](double mm) { return "--voxel " + format_number(mm, 2); };
  if (task.unresolved.leaves_doubt()) return voxel(solid::telling_voxel_mm(task.unresolved, task.grid.voxel_mm));
  if (!level.is_final()) return voxel(task.grid.voxel_mm);
  const auto& pieces = verdict.print.pieces;
  if (pieces && !pieces->knows_pieces()) return voxel(0.5 * task.grid.voxel_mm);
  return level.is_judged() ? "vam-optimize" : voxel(solid::resolving_voxel_mm(level.part.content, task.grid));
}

std::optional<WrongHeights> wrong_of(const optimize::Preview& preview, double stretch_z) {
  const std::vector<std::int64_t>& wrong = preview.outcome.wrong;
  const auto is_wrong = [](std::int64_t voxels) { return voxels > 0; };
  const auto first = std::find_if(wrong.begin(), wrong.end(), is_wrong);
  if (first == wrong.end()) return std::nullopt;
  const auto last = std::find_if(wrong.rbegin(), wrong.rend(), is_wrong).base() - 1;
  const auto mm = [&](auto at) { return preview.grid.z_mm(static_cast<double>(at - wrong.begin())) / stretch_z; };
  return WrongHeights{mm(first), mm(last), mm(std::max_element(wrong.begin(), wrong.end()))};
}

std::string unknown(const Estimate& made, const Level& level, const EstimateTask& task, const std::string& why) {
  return "unknown at " + format_number(made.voxel_mm, 3) + " mm" + why + "; " + told_by(level, made.verdict, task) +
         " tells";
}

/// Where the print of these voxels does not tell, or not within dose_margin, the verdict is left open.
void judge(Estimate& made, const Level& level, const EstimateTask& task) {
  const optimize::Preview preview = preview_of(level, task.printer);
  made.angles = optimize::PreviewTask{}.angles;
  made.iterations = preview.outcome.iterations;
  made.verdict = verdict_of(level, task, preview, preview.outcome);
  made.fails = made.verdict.fails();
  Told told = prints(level, made.verdict, task);
  const bool dose_decides = std::any_of(preview.beside.begin(), preview.beside.end(), [&](const auto& other) {
    return prints(level, verdict_of(level, task, preview, other), task).prints != told.prints;
  });
  if (dose_decides) told = {{}, format_number(100 * verdict::dose_margin) + " % of the dose decide"};
  if (!told.prints) made.verdict = leave_open(made.verdict, unknown(made, level, task, ", as " + told.why_not));
  made.wrong = wrong_of(preview, task.stretch_z);
  made.trials = preview.trials;
  const double pixels = level.printer.projector.pixel_mm / task.printer.projector.pixel_mm;
  made.trials.tolerances[axis] *= pixels;
  for (optimize::Single& one : made.trials.singles) one.ends_at *= one.tolerance == axis ? pixels : 1;
  made.by_angles = preview.by_angles;
  made.resin_known = resin::dose_per_radian_mj_cm3(task.printer).has_value();
  made.exposure = exposure_of(preview.outcome, task.printer);
  model::warn_of_diffusion(
      task.printer.resin,
      model::seconds_of(task.printer.stage, made.exposure ? made.exposure->turns : task.printer.stage.turns));
}

Estimate estimate_on(const Level& level, const EstimateTask& task) {
  Estimate made;
  made.voxel_mm = level.voxel_mm();
  made.verdict = verdict::judge(level.unresolved(), {});
  if (level.is_judged()) {
    judge(made, level, task);
  } else {
    made.verdict = leave_open(made.verdict, unknown(made, level, task, ""));
  }
  if (made.is_unknown() && !level.is_final()) {
    made.too_coarse = solid::resolution_doubts("at " + format_number(made.voxel_mm, 3) + " mm", level.unresolved(),
                                               level.part.volume.grid, task.stretch_z);
  }
  return made;
}

}  // namespace

Estimate estimated(const EstimateTask& task) {
  const auto voxels = [&](int coarseness) { return static_cast<double>(task.grid.size()) / std::pow(coarseness, 3); };
  int by = task.on_these_voxels ? 1 : usual_coarseness;
  while (!task.on_these_voxels && voxels(by) > most_coarse_voxels) by *= 2;
  while (true) {
    const Level level = level_of(task, by);
    const bool is_last = by == 1 || voxels(by / 2) > most_finer_voxels;
    if (is_last || hidden(level, task).empty()) {
      Estimate made = estimate_on(level, task);
      if (is_last || !made.is_unknown()) return made;
    }
    by /= 2;
  }
}

}  // namespace vam::plan_tool
