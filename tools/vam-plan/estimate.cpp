// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/coarser.hpp"
#include "model/dose_metrics.hpp"
#include "model/outside.hpp"
#include "optics/writable_radius.hpp"
#include "vam-plan/filled.hpp"
#include "vam-plan/steps.hpp"

namespace vam::plan_tool {

namespace {

double million_voxels(const model::Grid& grid, int coarseness) {
  return 1e-6 * static_cast<double>(grid.size()) / std::pow(coarseness, 3);
}

/// The part on the voxels of an estimate.
struct Coarse {
  model::Printer printer;
  Filled part;

  [[nodiscard]] const verdict::Unresolved& unresolved() const { return part.content.unresolved; }
  /// Whether some voxel is wholly inside the part.
  [[nodiscard]] bool is_judged() const {
    const std::vector<float>& values = part.volume.values;
    return std::any_of(values.begin(), values.end(),
                       [](float coverage) { return model::label_of(coverage) == model::Label::part; });
  }
  /// Whether walls and gaps are as thick as the voxels, but for edges: hardly any is lost, little is not resolved.
  [[nodiscard]] bool is_all_judged() const {
    constexpr double most_lost = 0.001;
    const double lost = unresolved().lost_walls.voxels + unresolved().lost_gaps.voxels;
    return is_judged() && lost <= most_lost * unresolved().whole && !unresolved().is_much();
  }
};

Coarse coarse(const solid::Part& part, const model::Printer& printer, int coarseness) {
  Coarse made{printer, {}};
  for (int by = 1; by < coarseness; by *= 2) made.printer = model::coarser(made.printer);
  made.part = filled(part, made.printer.projector.pixel_mm);
  return made;
}

optimize::Preview preview_of(Coarse coarse, int coarseness) {
  optimize::PreviewTask task;
  task.printer = std::move(coarse.printer);
  task.part = model::covered_box(coarse.part.volume, model::coverage_rounding);
  task.radius_mm = optics::judged_radius_mm(task.printer, coarse.part.content.radius_mm);
  task.target = std::move(coarse.part.volume);
  task.tolerances = model::parse_tolerances(deviations);
  task.tolerances[static_cast<std::size_t>(model::Deviating::axis)] /= coarseness;  // of the printer's pixels
  return optimize::preview(task);
}

void estimate(Plan& plan, Coarse judged) {
  const model::Grid& grid = judged.part.volume.grid;
  plan.unjudged = judged.unresolved();
  plan.all_judged = judged.is_all_judged();
  plan.unjudged_low_mm = grid.z_mm(judged.unresolved().first - 0.5) / plan.stretch_z;
  plan.unjudged_high_mm = grid.z_mm(judged.unresolved().end - 0.5) / plan.stretch_z;
  if (!judged.is_judged()) return;
  plan.preview = preview_of(std::move(judged), plan.coarseness);
  plan.pieces = plan.preview->outcome.pieces;
  if (!plan.pieces) return;
  plan.pieces->set_solids(plan.surface);
  plan.pieces->set_places(plan.preview->grid, plan.stretch_z);
}

}  // namespace

void add_preview(Plan& plan, const solid::Part& part, const model::Printer& printer) {
  int& by = plan.coarseness = usual_coarseness;
  while (million_voxels(plan.grid, by) > most_estimated) by *= 2;
  const auto can_be_finer = [&] { return by > 1 && million_voxels(plan.grid, by / 2) <= most_finer; };
  const solid::Part body = without_surface(part);
  Coarse judged = coarse(body, printer, by);
  while (!judged.is_all_judged() && can_be_finer()) judged = coarse(body, printer, by /= 2);
  estimate(plan, std::move(judged));
  const auto is_torn = [&] {  // where it prints at all
    return plan.preview && plan.preview->outcome.metrics.pw > 0 && plan.pieces && !plan.pieces->is_surely_as_part();
  };
  while (is_torn() && can_be_finer()) estimate(plan, coarse(body, printer, by /= 2));
}

}  // namespace vam::plan_tool
