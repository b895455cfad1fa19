// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/shortest.hpp"

#include <algorithm>

namespace vam::optimize {

void Search::exchange(Archive& archive) {
  archive(run.iteration);
  archive(run.best);
  archive(run.best_at);
  archive(run.best_light);
  archive(run.latitude);
  archive(max_intensity);
  archive(best_max_intensity);
  archive(until);
}

Outcome run_shortest(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                     const Raising& raising, Iterate& state, Search& search, const Watch& watch, const Pause& pause,
                     const AtLimit& at_limit) {
  if (raising.factor <= 0 || search.max_intensity <= 0) {
    search.best_max_intensity = search.max_intensity;
    return run_method(method, problem, light, limits, state, search.run, watch, pause);
  }
  if (search.until == 0) search.until = raising.first;
  for (;;) {
    Limits now = limits;
    now.iterations = std::min(limits.iterations, search.until);
    const double best_before = search.run.best;
    Outcome outcome = run_method(method, problem, light, now, state, search.run, watch, pause);
    if (search.run.best > best_before) search.best_max_intensity = search.max_intensity;
    const bool ended =
        outcome.stop == StopReason::goal || outcome.stop == StopReason::interrupted || outcome.stop == StopReason::time;
    if (at_limit && outcome.stop != StopReason::interrupted) at_limit(search.max_intensity);
    if (ended || outcome.iterations >= limits.iterations) return outcome;
    const bool stays = !search.run.latitude.empty() && search.run.latitude.back() >= raising.enough;
    if (stays && outcome.stop == StopReason::no_progress) return outcome;
    search.until = outcome.iterations + raising.next;
    if (stays) continue;
    search.max_intensity *= raising.factor;
    search.run.best_at = outcome.iterations;
    method.allow(search.max_intensity);
  }
}

}  // namespace vam::optimize
