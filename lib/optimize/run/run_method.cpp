// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/run_method.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "model/dose/figures.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/slice_figures.hpp"

namespace vam::optimize {

namespace {

constexpr double goal_merit = 10;  // conditions that are met count for more than all else
constexpr double true_rms = 0.1;   // voxels: up to this distance the surface is where it was asked for

/// Mean over the slices with part, less by how far the surface is off.
double mean_merit(const Method& method, const Iterate& state, const std::vector<model::DoseMetrics>& slices) {
  double sum = 0;
  int count = 0;
  for (const auto& m : slices) {
    if (m.part == 0) continue;
    sum += merit(m);
    ++count;
  }
  const auto surface = method.surface_miss(state.dose);
  return (count > 0 ? sum / count : 0.0) - (surface ? std::max(0.0, surface->rms - true_rms) : 0.0);
}

bool reached(const std::vector<model::Condition>& until, const model::DoseMetrics& m) {
  return !until.empty() && model::unmet(until, [&](const std::string& name) { return model::figure(m, name); }).empty();
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

/// Notes the latitude after this iteration.
void note(IterationState& run, double latitude) {
  run.latitude.resize(run.iteration, run.latitude.empty() ? latitude : run.latitude.back());
  run.latitude.push_back(run.latitude.empty() ? latitude : std::max(latitude, run.latitude.back()));
}

/// Outcome::growth after so many iterations.
double growth(const IterationState& run, int iterations) {
  constexpr double begun = 10;  // what comes before the first iteration and after the last takes, in iterations
  constexpr double share = 0.8;
  const double cost = iterations + begun;
  const int before = static_cast<int>(share * cost - begun);
  if (before < 0 || iterations >= count_of(run.latitude) || !(run.latitude[before] > 0)) return no_growth_known;
  return std::log(run.latitude[iterations] / run.latitude[before]) / std::log(cost / (before + begun));
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
  if (limits.watch_last || limits.iterations > 0) {  // looking costs little, but a plain fbp need not be evaluated
    auto slices = metrics(state.dose, problem);
    if (watch) watch(run.iteration, slices);
    if (light.couples_slices()) slices = {body_metrics(state.dose, problem)};  // one threshold prints them all
    SliceFigures figures;
    for (const auto& slice : slices) figures.add(slice);
    const model::DoseMetrics mean = figures.mean();
    note(run, mean.latitude);
    const bool met = reached(limits.until, mean);
    const auto counts = [&](int at) {
      return at >= limits.at_least && (limits.least_rate <= 0 || growth(run, at) < limits.least_rate);
    };
    const bool ends = met && counts(run.iteration);
    const bool goal = ends && (!limits.prints || limits.prints(state));
    const double merit_now = mean_merit(method, state, slices) + (met ? goal_merit : 0) + (goal ? goal_merit : 0);
    const bool lost = lost_patience(run, limits, merit_now, keeps ? &state.g : nullptr);
    if (goal) return StopReason::goal;
    if (ends && limits.leaves_open && counts(run.iteration / 2)) return StopReason::no_progress;
    if (!last && lost && run.iteration >= limits.at_least) return StopReason::no_progress;
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
  const bool keeps = limits.patience > 0 && limits.iterations > 1 && !method.asks_more();
  for (;; ++run.iteration) {
    const auto stop = looked ? std::nullopt : look(method, problem, light, limits, state, run, keeps, watch);
    if (stop) return {run.iteration, *stop, growth(run, run.iteration)};
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
