// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/volume.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/pass_run.hpp"
#include "optimize/run/private/shown_pass.hpp"
#include "verdict/print_pieces.hpp"

namespace vam::optimize {

namespace {

// The pieces of a print whose slices are optimised apart: their doses are computed once more, in ascending order, as
// their projections are handed out. Memory: the projections of a pass, and its doses.
class LightPieces {
 public:
  /// All are referred to. Not for a grey target, nor for a part of the slices.
  LightPieces(const VolumeTask& task, const light::Operator& light, const SliceReader& reader);
  /// The projections of the next slice, which that job computed.
  void add(int job, const Image& image);
  /// After the last slice.
  [[nodiscard]] verdict::PrintPieces found();

 private:
  /// Slices that follow each other and have one dose.
  struct Alike {
    Image image;
    int job, slice, count;
  };

  void count(const Pass& pass);

  const VolumeTask& task_;
  const light::Operator& light_;
  const SliceReader& reader_;
  Division division_;
  std::deque<Alike> held_;  // from number first_ on
  int first_ = 0;
  int next_ = 0;               // the number of the first that is not counted
  int slices_ = 0;             // so far
  std::vector<float> target_;  // slice
  verdict::PrintPieceCounter pieces_;
};

LightPieces::LightPieces(const VolumeTask& task, const light::Operator& light, const SliceReader& reader)
    : task_(task),
      light_(light),
      reader_(reader),
      division_(division_of(task, light)),
      target_(product(light.object().width, light.object().height)),
      pieces_(light.object().width, light.object().height, task.demands.window.threshold()) {}

void LightPieces::add(int job, const Image& image) {
  if (division_.halo == 0 && !held_.empty() && held_.back().job == job) {
    ++held_.back().count;
  } else {
    // The pass is complete, and no more slices are like its last one.
    const int known = first_ + count_of(held_);
    const Pass pass = division_.from(next_, std::numeric_limits<int>::max());
    if (pass.high <= known) count(pass);
    held_.push_back({image, job, slices_, 1});
  }
  ++slices_;
}

void LightPieces::count(const Pass& pass) {
  const auto of = [&](int number) -> const Alike& { return held_[number - first_]; };
  const ShownPass shown = shown_pass(
      task_, light_, reader_, pass, [&](int number) { return of(number).slice; },
      [&](int number) { return of(number).image; });
  for_each_dose(shown.dose, shown.problem, pass.first - pass.low, pass.last - pass.low,
                [&](int first, int count, const float* doses) {
                  for (int k = 0; k < count; ++k) {
                    const Alike& alike = of(pass.low + first + k);
                    task_.source.target(alike.slice, 1, target_.data());
                    for (int n = 0; n < alike.count; ++n)
                      pieces_.add(doses + product(k, target_.size()), target_.data(), 1);
                  }
                });
  next_ = pass.last;
  const int low = division_.from(next_, std::numeric_limits<int>::max()).low;
  for (; first_ < low; ++first_) held_.pop_front();
}

verdict::PrintPieces LightPieces::found() {
  const int all = first_ + count_of(held_);
  while (next_ < all) count(division_.from(next_, all));
  return pieces_.found();
}

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
  std::optional<LightPieces> pieces;  // of slices that are optimised apart
  if (task.counts_pieces() && !jobs.division.whole) pieces.emplace(task, light, reader);
  OutputQueue outputs(jobs, [&](int k, const Image& image) {
    if (pieces) pieces->add(jobs.schedule.job_of_slice[k], image);
    task.write(k, image);
  });
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
  if (pieces) run.outcome.pieces = pieces->found();
  run.outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return complete(run, outputs);
}

}  // namespace vam::optimize
