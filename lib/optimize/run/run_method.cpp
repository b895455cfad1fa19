// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/run_method.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/dose/figures.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/slice_figures.hpp"

namespace vam::optimize {

namespace {

/// Mean over the slices with part.
double mean_merit(const std::vector<model::DoseMetrics>& slices) {
  double sum = 0;
  int count = 0;
  for (const auto& m : slices) {
    if (m.part == 0) continue;
    sum += merit(m);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

bool reached(const std::vector<model::Condition>& until, const std::vector<model::DoseMetrics>& slices) {
  if (until.empty()) return false;
  SliceFigures all;
  for (const auto& slice : slices) all.add(slice);
  const auto m = all.mean();
  return model::unmet(until, [&](const std::string& name) { return model::figure(m, name); }).empty();
}

/// Nothing has improved for `patience` iterations.
bool lost_patience(IterationState& run, const Limits& limits, double merit_now, const std::vector<Slab>* kept) {
  if (merit_now > run.best + limits.least_gain) {
    run.best = merit_now;
    run.best_at = run.iteration;
    if (kept != nullptr) run.best_light = *kept;
  }
  return limits.patience > 0 && run.iteration - run.best_at >= limits.patience;
}

// Deviations of a true surface, in voxels: vam-sdf finds up to 0.06 more than the dose at the surface tells.
constexpr double true_mean = 0.05, true_rms = 0.2;

bool is_true(const std::optional<SurfaceMiss>& surface) {
  return surface && std::abs(surface->mean) <= true_mean && surface->rms <= true_rms;
}

/// Whether the goal counts at this iterate.
bool enough(const Method& method, const Limits& limits, const Iterate& state, int iteration) {
  if (iteration >= limits.at_least) return true;
  return limits.early > 0 && iteration >= limits.early && is_true(method.surface_miss(state.dose));
}

/// Whether another iteration as long as the mean of those before it, and the rest, fit in.
bool in_time(const std::optional<Deadline>& deadline, const IterationState& run) {
  if (!deadline) return true;
  const double now_s = deadline->now_s();
  const double each_s = (now_s - run.began_s) / std::max(1, run.iteration);
  return now_s + (1 + deadline->rest_iterations) * each_s <= deadline->end_s;
}

/// Whether to stop at this iterate, and why.
std::optional<StopReason> look(const Method& method, const Problem& problem, const light::Operator& light,
                               const Limits& limits, const Iterate& state, IterationState& run, bool keeps,
                               const Watch& watch) {
  const bool last = run.iteration == limits.iterations;
  if (limits.watch_last || !last || keeps) {  // looking costs little, but a plain fbp need not be evaluated
    auto slices = metrics(state.dose, problem);
    if (watch) watch(run.iteration, slices);
    if (light.couples_slices()) slices = {body_metrics(state.dose, problem)};  // one threshold prints them all
    if (reached(limits.until, slices) && enough(method, limits, state, run.iteration)) return StopReason::goal;
    const bool lost = lost_patience(run, limits, mean_merit(slices), keeps ? &state.g : nullptr);
    if (!last && lost) return StopReason::no_progress;
  }
  if (!last && !in_time(limits.deadline, run)) return StopReason::time;
  return last ? std::optional(StopReason::iterations) : std::nullopt;
}

}  // namespace

Deadline Deadline::share(double of) const {
  Deadline shorter = *this;
  const double now = now_s();
  shorter.end_s = now + of * std::max(0.0, end_s - now);
  return shorter;
}

std::string reason_name(StopReason stop) {
  switch (stop) {
    case StopReason::goal:
      return "goal";
    case StopReason::no_progress:
      return "no progress";
    case StopReason::interrupted:
      return "interrupted";
    case StopReason::time:
      return "time";
    case StopReason::iterations:
      break;
  }
  return "iterations";
}

Outcome run_method(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                   Iterate& state, IterationState& run, const Watch& watch, const Pause& pause) {
  bool looked = run.iteration >= 0;
  if (!looked) {
    if (limits.deadline) run.began_s = limits.deadline->now_s();
    if (state.g.empty()) {
      method.start(problem, light, state);
    } else {
      method.resume(problem, light, state);
    }
    run.iteration = 0;
  }
  const bool keeps = limits.patience > 0 && limits.iterations > 1 && !method.asks_more(problem);
  for (;; ++run.iteration) {
    const auto stop = looked ? std::nullopt : look(method, problem, light, limits, state, run, keeps, watch);
    if (stop) return {run.iteration, *stop};
    if (pause && pause()) return {run.iteration, StopReason::interrupted};
    method.step(problem, light, state);
    looked = false;
  }
}

bool return_to_best(const Problem& problem, const light::Operator& light, IterationState& run, Iterate& state) {
  if (run.best_light.empty() || run.best_at == run.iteration) return false;
  state.g = std::move(run.best_light);
  find_dose(problem, light, state);
  return true;
}

Outcome run_method(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                   Iterate& state) {
  IterationState run;
  return run_method(method, problem, light, limits, state, run);
}

}  // namespace vam::optimize
