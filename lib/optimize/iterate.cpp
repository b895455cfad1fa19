#include "optimize/iterate.hpp"

#include <limits>

#include "model/figures.hpp"
#include "optimize/slice_figures.hpp"

namespace vam::optimize {

namespace {

/// Mean over the slices with part of IoU + PW: IoU moves while part and void overlap, PW when they have come apart.
double merit(const std::vector<model::DoseMetrics>& slices) {
  double sum = 0;
  int count = 0;
  for (const auto& m : slices) {
    if (m.part == 0) continue;
    sum += m.iou + m.pw;
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

/// Notices when nothing has improved for `patience` iterations.
class Patience {
 public:
  explicit Patience(const Limits& limits) : limits_(limits) {}
  bool lost(int iteration, double merit) {
    if (merit > best_ + limits_.least_gain) {
      best_ = merit;
      best_at_ = iteration;
    }
    return limits_.patience > 0 && iteration - best_at_ >= limits_.patience;
  }

 private:
  const Limits& limits_;
  double best_ = -std::numeric_limits<double>::infinity();
  int best_at_ = 0;
};

}  // namespace

Outcome iterate(Method& method, const Problem& problem, const Operator& light, const Limits& limits, Iterate& state,
                const Watch& watch) {
  if (state.g.empty()) {
    method.start(problem, light, state);
  } else {
    method.resume(problem, light, state);
  }
  Patience patience(limits);
  for (int i = 0;; ++i) {
    const bool last = i == limits.iterations;
    if (watch || !last) {  // looking costs little, but a plain fbp need not be looked at
      const auto slices = metrics(state.dose, problem);
      if (watch) watch(i, slices);
      if (reached(limits.until, slices)) return {i, "goal"};
      if (!last && patience.lost(i, merit(slices))) return {i, "no progress"};
    }
    if (last) return {i, "iterations"};
    method.step(problem, light, state);
  }
}

}  // namespace vam::optimize
