// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/pass_run.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/threshold.hpp"

namespace vam::optimize {

void OutputQueue::take(std::vector<Image> images) {
  for (const Image& image : images) {
    if (std::all_of(image.values.begin(), image.values.end(), [](float v) { return std::isfinite(v); })) continue;
    throw Error{Fault::data, "projections of slice " + std::to_string(slices_) +
                                 " and those optimised with it are not finite; check the values of target and weights"};
  }
  for (Image& image : images) {
    if (jobs_.multiplicity[next_] > 0) held_.emplace(next_, std::move(image));
    if (++next_ == open()->last && ++pass_ < jobs_.passes.size()) next_ = open()->first;
  }
  write_ready();
}

void OutputQueue::write_ready() {
  for (; slices_ < jobs_.selection.to; ++slices_) {
    if (!jobs_.selection.holds(slices_)) continue;
    const int job = jobs_.schedule.job_of_slice[slices_];
    const auto found = held_.find(job);
    if (found == held_.end()) return;
    const std::vector<float>& values = found->second.values;
    peaks_[slices_] = *std::max_element(values.begin(), values.end());
    efficiency_.add(values);
    write_(slices_, found->second);
    if (jobs_.schedule.last_slice[job] == slices_) held_.erase(found);
  }
}

namespace {

/// Progress in iterations of a job. A goal may be met before the last of them, but not before the first that counts.
void show(const RunState& run, const Pass& pass, int iteration, const model::DoseMetrics& figures, Progress& progress) {
  const Limits& limits = run.task.limits;
  int expected = limits.iterations;
  if (!limits.until.empty() && limits.at_least > 0) expected = std::min(expected, limits.at_least);
  while (expected < iteration) expected *= 2;
  const int most = std::max(1, std::min(expected, limits.iterations));
  long before = 0, all = 0;
  for (const Pass& one : run.jobs.passes) {
    all += one.jobs();
    if (one.first < pass.first) before += one.jobs();
  }
  progress.set_progress(before * most + static_cast<long>(pass.jobs()) * iteration, all * most,
                        {{"iteration", static_cast<double>(iteration)}, {"VER", figures.ver}, {"PW", figures.pw}});
}

/// To the scale of what is written, which slices that share dose with other passes have, and what is missing of a dose.
void to_scale(const RunState& run, const PassPrinters& printers, double most, Iterate& state) {
  const Problem& problem = printers.setup.problem;
  if (run.jobs.division.halo > 0 || !problem.delivered.empty()) return;
  bring_to_threshold(problem, printers.setup.light.sharp(),
                     run.jobs.division.whole ? ExposureGroup::pass : ExposureGroup::slice, most, printers.all(), state);
}

/// Whether the slices of the pass, one on the other, print as the part, as the verdict finds it, and also with
/// dose_margin less and more dose. What the voxels are too coarse for is no obstacle.
bool prints(const RunState& run, const Pass& pass, const PassPrinters& printers, double most, Iterate state) {
  const Problem& problem = printers.setup.problem;
  to_scale(run, printers, most, state);
  model::DoseStatistics all;
  const auto slices = whole_statistics(state.dose, problem);
  for (int job = pass.first; job < pass.last; ++job) all.merge(slices[job - pass.low]);
  const model::DoseMetrics found = all.metrics();
  if (found.part == 0 || !(found.pw > 0)) return found.part == 0;
  const double threshold = verdict::aimed_dose(found, problem.demands.window.threshold());
  verdict::PrintPieceCounter counter(state.dose[0].width, state.dose[0].height, threshold);
  for (int k = 0; k < run.task.source.slices; ++k) {
    const int job = run.jobs.schedule.job_of_slice[k];
    if (job < pass.first || job >= pass.last) continue;
    count_pieces(state.dose, problem, job - pass.low, job - pass.low + 1, run.task.source, k - job + pass.low, counter);
  }
  const auto pieces = verdict::judge(run.task.unresolved, {.whole = found, .pieces = counter.found()}).print.pieces;
  return pieces->is_as_part() && pieces->holds_margin();
}

/// The pass has its share of the time that is left.
Limits limits_of(const RunState& run, const Pass& pass) {
  Limits limits = run.task.limits;
  limits.watch_last = run.task.watch;
  const double share = static_cast<double>(pass.jobs()) / (run.jobs.count() - pass.first);
  if (limits.deadline) limits.deadline = limits.deadline->share(share);
  return limits;
}

}  // namespace

void begin(RunState& run, const Pass& pass, const PassSetup& setup, PassState& work) {
  for (int job = pass.first; job < pass.last && !setup.dark.empty(); ++job)
    run.totals.add_dark(setup.dark[job - pass.low] * run.jobs.multiplicity[job]);
  work.search.max_intensity = run.first_limit;
  work.method = run.task.make(run.first_limit);
  if (!run.task.initial) return;
  work.state.g = collapse_images(
      pass, [&](int job) { return run.task.initial(run.jobs.slice(job)); }, setup.light.sharp());
}

bool iterate(RunState& run, const Pass& pass, const PassPrinters& printers, PassState& work, Progress& progress) {
  const VolumeTask& task = run.task;
  const Problem& problem = printers.setup.problem;
  const light::Operator& light = printers.setup.light.blurred();
  const Watch watch = [&](int iteration, const std::vector<model::DoseMetrics>& slices) {
    SliceFigures figures;
    for (int job = pass.first; job < pass.last; ++job) figures.add(slices[job - pass.low], run.jobs.multiplicity[job]);
    show(run, pass, iteration, figures.mean(), progress);
    if (task.watch) run.totals.note(iteration, figures);
  };
  AtLimit at_limit;
  if (task.front) {
    at_limit = [&](double most) {
      run.outcome.front.push_back(front_point(problem, light, most, work.state, printers.all(), task.front));
    };
  }
  Search& search = work.search;
  Limits limits = limits_of(run, pass);
  if (!task.demands.grey)
    limits.prints = [&](const Iterate& state) { return prints(run, pass, printers, search.max_intensity, state); };
  const Outcome outcome = run_shortest(*work.method, problem, light, limits, task.raising, work.state, search, watch,
                                       task.checkpoint.pause, at_limit);
  if (outcome.stop == StopReason::interrupted) return false;
  if (return_to_best(problem, light, search.run, work.state)) search.max_intensity = search.best_max_intensity;
  search.run.best_light = {};
  run.totals.end(outcome);
  return true;
}

void finish(RunState& run, const Pass& pass, const PassPrinters& printers, PassState& work) {
  const VolumeTask& task = run.task;
  const Problem& problem = printers.setup.problem;
  const double most = work.search.max_intensity;
  VolumeOutcome& outcome = run.outcome;
  outcome.least_ratio = std::max(outcome.least_ratio, work.method->provable_ratio());
  outcome.max_intensity = std::max(outcome.max_intensity, most);  // the brightest pass sets the duration
  Iterate& state = work.state;
  if (task.certify > 0) outcome.certificate = certify(problem, printers.setup.light.blurred(), state.g, task.certify);
  to_scale(run, printers, most, state);
  if (run.jobs.division.whole) outcome.surface = work.method->surface_miss(state.dose);
  run.totals.add(state.dose, problem, pass, run.jobs, task.part);
}

void hand_out(const RunState& run, const Pass& pass, const light::Operator& light, PassState work,
              OutputQueue& outputs) {
  work.method.reset();
  work.state.dose.clear();
  for (std::size_t s = 0; s < work.state.g.size(); ++s) {
    std::vector<Image> images = expand_slab(pass, s, work.state.g[s], light);
    work.state.g[s] = {};
    if (images.empty()) continue;
    if (run.task.checkpoint.to != nullptr) keep_finished(*run.task.checkpoint.to, images);
    outputs.take(std::move(images));
  }
}

}  // namespace vam::optimize
