// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/shown.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/index.hpp"
#include "model/dose/figures.hpp"
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/run_totals.hpp"
#include "optimize/run/private/shown_pass.hpp"

namespace vam::optimize {

std::vector<VolumeOutcome> prints_at(const VolumeTask& task, const light::Operator& light,
                                     std::span<const Image> frames, std::span<const double> doses) {
  const SliceReader reader(task.source, light.object());
  const Jobs jobs = every_slice(task.source.slices, division_of(task, light));
  const Frames shown_frames(frames, light.image());
  const light::Shape object = light.object();
  struct Print {
    RunTotals totals;
    std::optional<verdict::PrintPieceCounter> pieces;
    VolumeOutcome outcome;
  };
  std::vector<Print> prints(doses.size());
  for (std::size_t i = 0; i < doses.size(); ++i) {
    if (!task.demands.grey && doses[i] > 0) prints[i].pieces.emplace(object.width, object.height, doses[i]);
  }
  for (const Pass& pass : jobs.passes) {
    ShownPass shown = shown_pass(
        task, light, reader, pass, [](int k) { return k; }, [&](int k) { return shown_frames[k]; });
    for (std::size_t i = 0; i < doses.size(); ++i) {
      auto& [totals, pieces, outcome] = prints[i];
      shown.problem.demands.window = {doses[i], doses[i]};
      totals.add(shown.dose, shown.problem, pass, jobs, task.part);
      if (light.couples_slices() && !task.demands.grey) outcome.wrong = wrong_voxels(shown.dose, shown.problem);
      if (pieces) {
        count_pieces(shown.dose, shown.problem, pass.first - pass.low, pass.last - pass.low, task.source, pass.low,
                     *pieces);
      }
    }
  }
  std::vector<VolumeOutcome> outcomes;
  for (auto& [totals, pieces, outcome] : prints) {
    totals.complete(outcome, task.demands.grey, jobs.schedule.job_of_slice);
    if (pieces) outcome.pieces = pieces->found();
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

void judge_shown(const VolumeTask& task, const light::Operator& light, std::span<const Image> frames,
                 const AimedDose& aimed, VolumeOutcome& outcome) {
  const Frames shown(frames, light.image());
  const double threshold = task.demands.window.threshold();
  VolumeOutcome judged = prints_at(task, light, frames, {{threshold}}).front();
  const double dose = task.demands.grey ? threshold : aimed(judged.metrics);
  if (dose != threshold) judged = prints_at(task, light, frames, {{dose}}).front();
  outcome.metrics = judged.metrics;
  outcome.all_cut = judged.all_cut;
  outcome.with_cut = judged.with_cut;
  outcome.outside = judged.outside;
  outcome.wrong = std::move(judged.wrong);
  outcome.pieces = judged.pieces;
  outcome.demands = std::move(judged.demands);
  outcome.surface.reset();
  model::LightEfficiency seen;
  for (int k = 0; k < task.source.slices; ++k) {
    const std::vector<float>& values = shown[k].values;
    seen.add(values);
    if (k < count_of(outcome.demands)) outcome.demands[k].peak = *std::max_element(values.begin(), values.end());
  }
  outcome.efficiency = seen.value();
  outcome.peak_intensity = seen.max;
}

double judge_exposed(VolumeTask& task, const light::Operator& light, std::span<const Image> frames,
                     const AimedDose& aimed, const PrintSeconds& seconds, const std::function<double(double)>& blur_px,
                     VolumeOutcome& outcome) {
  constexpr int most = 8;  // more turns blur more, which may take more turns
  double taken = seconds(outcome);
  for (int times = 0; times < most && blur_px(taken) != task.blur_px; ++times) {
    task.blur_px = blur_px(taken);
    judge_shown(task, light, frames, aimed, outcome);
    taken = seconds(outcome);
  }
  return taken;
}

}  // namespace vam::optimize
