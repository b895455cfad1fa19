#include "optimize/run/run_method.hpp"

#include "model/figures.hpp"
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
bool lost_patience(Course& course, const Limits& limits, double reached) {
  if (reached > course.best + limits.least_gain) {
    course.best = reached;
    course.best_at = course.iteration;
  }
  return limits.patience > 0 && course.iteration - course.best_at >= limits.patience;
}

/// Why to stop at this iterate; empty = go on.
std::string look(const Problem& problem, const light::Operator& light, const Limits& limits, const Iterate& state,
                 Course& course, const Watch& watch) {
  const bool last = course.iteration == limits.iterations;
  if (watch || !last) {  // looking costs little, but a plain fbp need not be evaluated
    auto slices = metrics(state.dose, problem);
    if (watch) watch(course.iteration, slices);
    if (light.couples_slices()) slices = {body_metrics(state.dose, problem)};  // one threshold prints them all
    if (course.iteration >= limits.at_least && reached(limits.until, slices)) return "goal";
    if (!last && lost_patience(course, limits, mean_merit(slices))) return "no progress";
  }
  return last ? "iterations" : "";
}

}  // namespace

Outcome run_method(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                   Iterate& state, Course& course, const Watch& watch, const Pause& pause) {
  bool looked = course.iteration >= 0;
  if (!looked) {
    state.g.empty() ? method.start(problem, light, state) : method.resume(problem, light, state);
    course.iteration = 0;
  }
  for (;; ++course.iteration) {
    const std::string reason = looked ? "" : look(problem, light, limits, state, course, watch);
    if (!reason.empty()) return {course.iteration, reason};
    if (pause && pause()) return {course.iteration, "interrupted"};
    method.step(problem, light, state);
    looked = false;
  }
}

Outcome run_method(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                   Iterate& state) {
  Course course;
  return run_method(method, problem, light, limits, state, course);
}

}  // namespace vam::optimize
