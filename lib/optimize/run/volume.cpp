// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/volume.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/private/pass_run.hpp"
#include "optimize/run/private/shown_pass.hpp"

namespace vam::optimize {

namespace {

/// The limit of the intensity that passes begin with, and the even dose that it is a multiple of.
void limit_intensity(RunState& run) {
  const VolumeTask& task = run.task;
  VolumeOutcome& outcome = run.outcome;
  const IntensityLimit& limit = task.limit;
  if (limit.most <= 0 && limit.of_even <= 0) return;
  outcome.even = even_dose(run.light, task.circle, run.jobs.division.whole ? task.source.slices : lanes);
  if (!(outcome.even.mean > 0)) return;  // dark: nothing to limit
  const double threshold = task.demands.window.threshold();
  outcome.max_intensity = limit.most > 0 ? limit.most : limit.of_even * threshold / outcome.even.mean;
  const double least = threshold / outcome.even.largest;
  if (task.raising.factor > 0) outcome.max_intensity = std::max(outcome.max_intensity, least);
  run.first_limit = outcome.max_intensity;
  const double reached = outcome.max_intensity * outcome.even.largest;
  // Light for the rest of a dose may be any that is left.
  if (task.demands.grey || task.source.delivered || outcome.max_intensity >= least) return;
  throw Error{Fault::usage, "a maximum intensity of " + format_number(outcome.max_intensity, 3) +
                                " gives a dose of at most " + format_number(reached, 3) +
                                " if every pixel is lit at every angle, and the threshold is " +
                                format_number(threshold) + "; more than " + format_number(least, 3) + " is needed"};
}

/// The open pass, and what the ended ones left behind.
void exchange_open(Archive& archive, RunState& run, PassState& work) {
  VolumeOutcome& outcome = run.outcome;
  run.totals.exchange(archive);
  archive(outcome.even.mean);
  archive(outcome.even.largest);
  archive(run.first_limit);
  archive(outcome.max_intensity);
  archive(outcome.least_ratio);
  exchange(archive, outcome.front);
  work.search.exchange(archive);
  if (!work.method) work.method = run.task.make(work.search.max_intensity);
  archive(work.state.g);
  archive(work.state.dose);
  work.method->exchange(archive);
  archive.seal();
}

/// Without a result; the state is kept where it is wanted.
VolumeOutcome interrupted(RunState& run, PassState& work) {
  if (Archive* to = run.task.checkpoint.to) {
    begin_open(*to);
    exchange_open(*to, run, work);
  }
  VolumeOutcome outcome;
  outcome.stop = StopReason::interrupted;
  return outcome;
}

RunMark mark_of(const VolumeTask& task, std::span<const SliceDigest> digests) {
  RunMark mark{task.checkpoint.job, {}, task.watch};
  for (const SliceDigest& slice : digests) {
    mark.target = {mark.target[0] * 31 + slice[0], mark.target[1] * 31 + slice[1]};
  }
  return mark;
}

/// From the start, or from the state of an interrupted run: finished passes are handed on as if they had just been
/// computed, the open one is taken up.
void start(RunState& run, const RunMark& mark, OutputQueue& outputs, PassState& work) {
  Archive* to = run.task.checkpoint.to;
  Archive* from = run.task.checkpoint.from;
  if (to != nullptr) exchange(*to, mark);
  if (from == nullptr) return limit_intensity(run);
  exchange(*from, mark);
  while (auto images = next_finished(*from, run.light.image(), outputs.left())) {
    if (to != nullptr) keep_finished(*to, *images);
    outputs.take(std::move(*images));
  }
  exchange_open(*from, run, work);
  from->end();
}

VolumeOutcome complete(RunState& run, const OutputQueue& outputs) {
  VolumeOutcome& outcome = run.outcome;
  run.totals.complete(outcome, run.task.demands.grey, run.jobs.schedule.job_of_slice);
  for (std::size_t k = 0; k < outcome.demands.size(); ++k) {
    outcome.demands[k].peak = static_cast<double>(outputs.peaks()[k]);
  }
  const std::vector<int>& times = run.jobs.multiplicity;
  outcome.jobs = static_cast<int>(std::count_if(times.begin(), times.end(), [](int n) { return n > 0; }));
  outcome.efficiency = outputs.efficiency();
  outcome.peak_intensity = outputs.peak();
  if (outcome.even.mean > 0) outcome.even_intensity = run.task.demands.window.threshold() / outcome.even.mean;
  return std::move(outcome);
}

/// Throws Fault::usage for a method that cannot compensate a blur between slices.
void require_scale(const VolumeTask& task, const light::Operator& light) {
  if (task.blur_px <= 0 || light.couples_slices() || task.make(0)->keeps_scale()) return;
  const auto able = method_names([](const MethodEntry& entry) { return entry.make({})->keeps_scale(); });
  throw Error{Fault::usage,
              "this method scales each slice separately and cannot compensate a blur between slices; use " +
                  join(able, ", ") + ", or neglect the blur"};
}

}  // namespace

VolumeOutcome optimise(const VolumeTask& task, const light::Operator& light) {
  require_scale(task, light);
  const auto digests = check(task.source, light.object(), task.circle, task.demands.grey);
  const Jobs jobs = jobs_of(task, light, digests);
  const SliceReader reader(task.source, light.object());
  OutputQueue outputs(jobs, task.write);
  const auto began = std::chrono::steady_clock::now();
  RunState run{task, light, jobs};
  PassState work;
  start(run, mark_of(task, digests), outputs, work);
  Progress progress(task.title, 0);
  while (const Pass* open = outputs.open()) {
    const Pass pass = *open;
    PassPrinters printers{set_up(task, light, reader, pass, [&](int job) { return jobs.slice(job); })};
    const PassSetup& setup = printers.setup;
    if (task.scenarios) printers.scenarios.emplace(setup.light.sharp(), task.scenarios(setup.inserts), pass.slices());
    if (!work.method) begin(run, pass, setup, work);
    if (printers.scenarios) work.method->set_scenarios(*printers.scenarios);
    if (!iterate(run, pass, printers, work, progress)) return interrupted(run, work);
    finish(run, pass, printers, work);
    hand_out(run, pass, setup.light.sharp(), std::exchange(work, {}), outputs);
  }
  run.outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return complete(run, outputs);
}

}  // namespace vam::optimize
