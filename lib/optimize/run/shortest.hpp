// SPDX-License-Identifier: GPL-3.0-or-later
// The shortest print: the duration is proportional to the largest intensity, so a pass begins with little and is
// allowed more when its goal is not met. Projections within a limit are within every higher one, so that nothing is
// lost; a limit that is lowered costs as many iterations as beginning anew.
#pragma once

#include <limits>

#include "optimize/run/run_method.hpp"

namespace vam::optimize {

struct Raising {
  double factor = 0;                                        // of the limit, each time; 0: it is fixed
  int first = 0;                                            // iterations with the first limit
  int next = 0;                                             // and with each one after it
  double enough = std::numeric_limits<double>::infinity();  // the latitude with which it stays
};

/// Times the even intensity (volume.hpp) to begin with: every part of tests/bench/printability prints with twice of it.
/// It is raised while a print forgives less than 3 % of dose either way.
inline constexpr double usual_of_even = 2;
inline constexpr Raising usual_raising{.factor = 1.5, .first = 16, .next = 8, .enough = 0.06};
/// The same parts print with 1.2 to 1.45 times, in 8 to 31 iterations.
inline constexpr double shortest_of_even = 1.2;
inline constexpr Raising shortest_raising{.factor = 1.1, .first = 24, .next = 6};

/// The front of duration against window: 8 limits from 1.2 to 7.5 times the even intensity.
inline constexpr Raising front_raising{.factor = 1.3, .first = 24, .next = 10};
inline constexpr int front_points = 8;
/// Iterations that reach the last of them.
inline constexpr int front_iterations = front_raising.first + (front_points - 1) * front_raising.next;

/// State of a search.
struct Search {
  IterationState run;
  double max_intensity = 0;       // in force; 0: none
  double best_max_intensity = 0;  // that was in force for run.best_light
  int until = 0;                  // the iteration up to which it is
  void exchange(Archive& archive);
};

/// Called with a limit whose iterations are done.
using AtLimit = std::function<void(double max_intensity)>;

/// As run_method(), which it is when the limit is fixed or there is none; else the limit is raised until the goal is
/// met or limits.iterations are done.
Outcome run_shortest(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                     const Raising& raising, Iterate& state, Search& search, const Watch& watch, const Pause& pause,
                     const AtLimit& at_limit = {});

}  // namespace vam::optimize
