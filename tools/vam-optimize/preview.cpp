// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/preview.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/json.hpp"
#include "base/text.hpp"
#include "io/settings/report.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/stream.hpp"
#include "model/coarser.hpp"
#include "model/magnification.hpp"
#include "model/metadata.hpp"
#include "optimize/run/printable.hpp"
#include "optimize/run/volume.hpp"
#include "score/exposure_plan.hpp"
#include "session/dose_score.hpp"
#include "vam-optimize/coarse_start.hpp"
#include "vam-optimize/exposure.hpp"
#include "vam-optimize/task.hpp"
#include "verdict/unresolved.hpp"
#include "verdict/verdict.hpp"

namespace vam::optimize_tool {

namespace {

constexpr int least_voxels = 24;      // a side of the part
constexpr int least_of_slow = 7;      // of one whose finer voxels take long
constexpr double most_updates = 2e8;  // voxels x angles: a projection of those takes 0.1 s
constexpr double hopeless = 0.5;      // not resolved, relative to the part
constexpr int least_iterations = 4, most_iterations = 16;
constexpr int proof_iterations = 40;
constexpr double proof_updates = 4e8;  // voxels x angles x iterations
constexpr double sure_window = 0.03;   // of the largest dose: what the finer voxels may cost

/// The job at some resolution.
struct Level {
  int pixels = 1;  // of the target's voxels, for one of these
  model::Printer printer;
  Options options;
  session::JobVolumes own;            // none at the target's own resolution
  const session::JobVolumes* finest;  // the target's own
  session::Scene scene = {};
  verdict::Unresolved unresolved = {};  // of its own voxels, once it is asked for

  [[nodiscard]] const session::JobVolumes& in() const { return own.target.empty() ? *finest : own; }
  [[nodiscard]] double updates() const { return static_cast<double>(scene.grid.size()) * options.angles; }
};

Level coarser(const Level& fine) {
  Level coarse{2 * fine.pixels, model::coarser(fine.printer), coarser(fine.options), coarser(fine.in()), nullptr};
  coarse.scene = session::make_scene(coarse.own.target.front(), coarse.printer, coarse.options);
  return coarse;
}

bool is_quick(const Level& level) { return level.updates() <= most_updates; }

bool can_be_coarser(const Level& level) {
  const model::Grid& grid = level.in().grid();
  return std::min(grid.nx, grid.ny) >= 2 * (is_quick(level) ? least_voxels : least_of_slow) && grid.nz > 1;
}

/// One, two and four voxels of the target, down to the coarsest that shows all of the part, or that is quick enough.
std::vector<Level> levels_of(const model::Printer& printer, const session::JobVolumes& in, const Options& options) {
  std::vector<Level> levels;
  levels.push_back({1, printer, options, {}, &in, session::make_scene(in.target.front(), printer, options)});
  levels.front().unresolved = session::sub_voxel_features(in.target.front());
  while (levels.back().pixels < 4) {
    if (!can_be_coarser(levels.back())) break;
    levels.push_back(coarser(levels.back()));
  }
  for (; levels.size() > 1; levels.pop_back()) {
    Level& level = levels.back();
    level.unresolved = session::sub_voxel_features(level.own.target.front());
    if (!level.unresolved.is_much() || !is_quick(levels[levels.size() - 2])) break;
  }
  return levels;
}

SolvedLevel solved(Level& level, int proof, std::optional<CoarseStart> start, int at_least = least_iterations) {
  const session::Scene& scene = level.scene;
  optimize::VolumeTask task = make_task(scene, level.in(), level.options);
  if (level.pixels == 1) {
    optimize::require_printable(task, {scene.grid.nx, scene.grid.ny}, io::input_name(level.options.input));
  }
  task.limits.patience = task.limits.early = 0;
  task.limits.iterations = std::min(task.limits.iterations, most_iterations);
  task.limits.at_least = std::min(task.limits.iterations, at_least);
  task.certify = proof;
  task.count_pieces = true;
  if (!start) start = coarse_start(level.in(), scene, level.options);
  if (start) continue_from(std::move(*start), task, level.options);
  return solved(task, scene, level.options);
}

/// In the print.
struct Place {
  double low_mm, high_mm, worst_mm;  // slices with wrong voxels, and the one with most of them
};

std::optional<Place> place_of(const optimize::VolumeOutcome& outcome, const session::Scene& scene) {
  const std::vector<std::int64_t>& wrong = outcome.wrong;
  const auto first = std::find_if(wrong.begin(), wrong.end(), [](auto n) { return n > 0; });
  if (first == wrong.end()) return std::nullopt;
  const auto last = std::find_if(wrong.rbegin(), wrong.rend(), [](auto n) { return n > 0; }).base() - 1;
  const auto worst = std::max_element(wrong.begin(), wrong.end());
  const auto mm = [&](auto at) {
    return model::vertical_magnification(scene.printer) * scene.grid.z_mm(static_cast<double>(at - wrong.begin()));
  };
  return Place{mm(first), mm(last), mm(worst)};
}

std::string mm(double value) { return format_number(value, 3) + " mm"; }

std::string unseen(const Level& level) {
  const model::Grid& grid = level.in().grid();
  return format_number(100 * level.unresolved.share(), 3) + " % of the part are walls or gaps too thin for voxels of " +
         mm(grid.voxel_mm) +
         ", most at z = " + mm(model::vertical_magnification(level.printer) * grid.z_mm(level.unresolved.slice));
}

/// Walls and gaps that the target's own voxels lose.
std::vector<std::string> lost(const verdict::Unresolved& target) {
  std::vector<std::string> doubts;
  if (target.loses_walls()) {
    const std::string what = target.loses_much()
                                 ? format_number(100 * target.lost_share(), 3) + " % of the part is in walls"
                                 : "walls or rods are";
    doubts.push_back(what + " too thin for the target's voxels and will be missing");
  }
  if (target.shuts_gaps()) doubts.emplace_back("gaps too narrow for the target's voxels will be shut");
  const std::string thin = target.thin_places();
  if (!thin.empty()) doubts.push_back(thin + " of the target are not judged");
  if (target.surface && target.surface->may_be_pierced()) {
    doubts.emplace_back(
        "walls or gaps of about two voxels of the target may have holes or bridges, which is judged without --preview");
  }
  if (!target.surface && target.is_much()) {
    doubts.push_back(format_number(100 * target.share(), 3) +
                     " % of the part are walls or gaps too thin for the target's voxels");
  }
  return doubts;
}

/// What is known of the print.
struct Answer {
  const char* prints;  // yes, no, unsure
  std::string words;
  std::vector<std::string> reasons;
  bool is_torn = false;  // as a reason
};

Answer unsure(const std::vector<std::string>& reasons) {
  return {"unsure", "may not print: " + join(reasons, "; "), reasons};
}

/// Of the estimate; the surface of the target may tell the part's.
std::optional<verdict::PrintPieces> pieces_of(const Level& level, const optimize::VolumeOutcome& outcome,
                                              const verdict::Unresolved& target) {
  auto pieces = outcome.pieces;
  if (!pieces) return pieces;
  if (target.surface) pieces->set_solids(target.surface->places);
  pieces->set_places(level.scene.grid, model::stretch_z(level.in().target.front().metadata));
  return pieces;
}

/// In other pieces than the part, or with cut walls, shut gaps or holes.
bool is_torn(const Level& level, const optimize::VolumeOutcome& outcome, const verdict::Unresolved& target) {
  const auto pieces = pieces_of(level, outcome, target);
  return pieces && !pieces->is_surely_as_part();
}

/// `target`: of its own voxels.
Answer answer_of(const Level& level, const verdict::Unresolved& target, const optimize::VolumeOutcome& outcome,
                 double least) {
  const model::DoseMetrics& doses = outcome.metrics;
  if (least >= 1) return {"no", "will not print, by any projections", {}};
  if (!(doses.pw > 0)) return {"no", "will not print", {}};
  std::vector<std::string> doubts = lost(target);
  const bool torn = is_torn(level, outcome, target);
  if (torn) doubts.push_back("in the estimate " + verdict::words(*pieces_of(level, outcome, target)));
  if (level.pixels > 1 && level.unresolved.is_much()) doubts.push_back(unseen(level));
  if (doses.pw < sure_window) doubts.emplace_back("the process window is narrow");
  Answer answer = doubts.empty() ? Answer{"yes", "will print", {}} : unsure(doubts);
  answer.is_torn = torn;
  return answer;
}

/// All that is told.
struct Seen {
  Answer answer;
  std::optional<model::DoseMetrics> doses = {};
  double least_void_over_part = 0;  // of any light; 0: not known
  std::optional<Place> place = {};
  std::optional<score::ExposurePlan> plan = {};
  double voxel_mm = 0;
  int angles = 0, iterations = 0;
  verdict::Unresolved unresolved = {};
};

/// Iterations of a proof.
int proof_on(const Level& level) {
  return static_cast<int>(std::clamp(proof_updates / level.updates(), 1.0, 1.0 * proof_iterations));
}

/// What coarser voxels tell of this level.
struct FromCoarser {
  double least = 0;  // max_V x / min_G x of any light; 0: not known
  std::optional<CoarseStart> start = {};
};

FromCoarser from_coarser(const Level& level) {
  Level coarse = coarser(level);
  if (session::sub_voxel_features(coarse.own.target.front()).share() > hopeless) return {};
  SolvedLevel found = solved(coarse, proof_on(coarse), {});
  const double least = found.outcome.certificate->least;
  return {least, start_of(std::move(found), coarse.scene, coarse.options, level.scene, level.options)};
}

Seen see(Level& level, const verdict::Unresolved& target) {
  level.unresolved = level.pixels == 1 ? target : session::sub_voxel_features(level.own.target.front());
  if (level.unresolved.share() > hopeless) return {.answer = unsure({unseen(level)}), .unresolved = level.unresolved};
  session::warn_of(level.scene, level.in().target.front(), level.options);
  const bool has_coarser = can_be_coarser(level);
  const FromCoarser below = has_coarser ? from_coarser(level) : FromCoarser{};
  optimize::VolumeOutcome outcome = solved(level, has_coarser ? 0 : proof_on(level), below.start).outcome;
  const bool can_go_on =
      outcome.iterations < std::min(level.options.iterations.value_or(most_iterations), most_iterations);
  if (outcome.metrics.pw > 0 && is_torn(level, outcome, target) && can_go_on) {  // more than the process window needs
    auto certificate = outcome.certificate;
    outcome = solved(level, 0, below.start, most_iterations).outcome;
    outcome.certificate = certificate;
  }
  optimize::require_light(outcome, io::input_name(level.options.input),
                          level.options.surface_margin_mm / level.in().grid().voxel_mm);
  const double least = outcome.certificate ? outcome.certificate->least : below.least;
  Seen seen{answer_of(level, target, outcome, least), outcome.metrics, least};
  seen.place = place_of(outcome, level.scene);
  seen.plan = exposure_of(outcome.metrics, outcome.peak_intensity, level.printer, {}, level.options);
  seen.voxel_mm = level.scene.grid.voxel_mm;
  seen.angles = level.options.angles;
  seen.iterations = outcome.iterations;
  seen.unresolved = level.unresolved;
  return seen;
}

std::string row(const std::string& name, const std::string& value) {
  return name + std::string(std::max<std::size_t>(1, 16 - name.size()), ' ') + value + "\n";
}

std::string table(const Seen& seen) {
  const double least = seen.least_void_over_part;
  std::string text = row("verdict", seen.answer.words);
  if (!seen.doses) return text;
  text += row("process window",
              format_number(seen.doses->pw, 2) + " of the largest dose, VER " + format_number(seen.doses->ver, 2) +
                  (least > 0 ? "; at most " + format_number(1 - least, 2) + " by any projections" : ""));
  text +=
      row("duration", seen.plan ? format_number(seen.plan->seconds, 3) + " s in " + std::to_string(seen.plan->turns) +
                                      (seen.plan->turns == 1 ? " turn" : " turns")
                                : "not known; set resin.critical_dose_mj_cm3 and resin.absorption_per_mm");
  if (seen.place) {
    text += row("wrong voxels", "z = " + mm(seen.place->low_mm) + " to " + mm(seen.place->high_mm) + ", most at " +
                                    mm(seen.place->worst_mm));
  }
  return text + row("estimate", "voxels of " + mm(seen.voxel_mm) + ", " + std::to_string(seen.angles) + " angles, " +
                                    std::to_string(seen.iterations) + " iterations");
}

Json report_of(const Seen& seen) {
  Json report{{"prints", seen.answer.prints}, {"reasons", seen.answer.reasons}};
  report["unresolved_part"] = seen.unresolved.part_share();
  report["unresolved_gaps"] = seen.unresolved.gap_share();
  if (!seen.doses) return report;
  report["ver"] = seen.doses->ver;
  report["pw"] = seen.doses->pw;
  report["iou"] = seen.doses->iou;
  report["least_void_over_part"] = seen.least_void_over_part;
  report["voxel_mm"] = seen.voxel_mm;
  report["angles"] = seen.angles;
  report["iterations"] = seen.iterations;
  if (seen.place) {
    report["wrong"] = {
        {"low_mm", seen.place->low_mm}, {"high_mm", seen.place->high_mm}, {"worst_mm", seen.place->worst_mm}};
  }
  if (seen.plan) add_to(report, *seen.plan);
  return report;
}

}  // namespace

void preview(const model::Printer& printer, const session::JobVolumes& in, const Options& options) {
  const verdict::Unresolved target = session::sub_voxel_features(in.target.front());
  std::vector<Level> levels = levels_of(printer, in, options);
  Seen seen = see(levels.back(), target);
  while (seen.answer.is_torn && levels.size() > 1 && is_quick(levels[levels.size() - 2])) {  // by its voxels, perhaps
    levels.pop_back();
    seen = see(levels.back(), target);
  }
  if (options.report != "-") io::write_text("-", table(seen));
  io::write_report(options.report, "vam-optimize-preview", report_of(seen));
}

}  // namespace vam::optimize_tool
