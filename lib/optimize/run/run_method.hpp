// SPDX-License-Identifier: GPL-3.0-or-later
// Main iteration loop: step, evaluate, test the stopping criteria.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/conditions.hpp"
#include "optimize/methods/method.hpp"

namespace vam::optimize {

/// When a run must have ended, and its clock.
struct Deadline {
  std::function<double()> now_s;
  double end_s = 0;
  double rest_iterations = 3;  // duration of what follows the last one, in iterations

  /// The deadline of a stage that may take this fraction of the time that is left.
  [[nodiscard]] Deadline share(double of) const;
};

struct Limits {
  int iterations = 0;
  std::vector<model::Condition> until;              // stop when all hold; names as in SliceFigures::names()
  std::function<bool(const Iterate&)> prints = {};  // and the print is the part; empty: not asked
  int at_least = 0;                                 // iterations before they count, or patience ends
  double least_rate = 0;                  // and growth of the latitude per growth of the cost, in logarithms, above
                                          // which the run goes on; 0: none
  bool leaves_open = false;               // stop at twice the iterations that count, though it is not the part
  int patience = 10;                      // stop when nothing improved in so many iterations; 0 = never
  double least_gain = 1e-4;               // an improvement of the mean of IoU + latitude smaller than this is none
  bool watch_last = false;                // evaluate the last iterate, too, on which nothing depends
  std::optional<Deadline> deadline = {};  // no iteration begins that might end after it
};

/// Why a run ended: all iterations done, the conditions met, nothing gained by further iterations, broken off, or no
/// time left.
enum class StopReason : int { iterations, goal, no_progress, interrupted, time };

/// As reports have it: "iterations", "goal", "no progress", "interrupted", "time".
[[nodiscard]] std::string reason_name(StopReason stop);

/// Of the latitude: that of a run that did not print before.
inline constexpr double no_growth_known = 1e6;

struct Outcome {
  int iterations = 0;
  StopReason stop = StopReason::iterations;
  double growth = no_growth_known;  // of the latitude in the last fifth of the cost, in logarithms of both
};

/// Called with iteration 0 (the start) and after every step that is evaluated; one entry per slice of the pass.
using Watch = std::function<void(int iteration, const std::vector<model::DoseMetrics>& slices)>;
/// Asked after every complete iterate whether to break off there.
using Pause = std::function<bool()>;

/// State of a run after `iteration` complete steps: the best merit so far, its iteration and its light. Merit is the
/// mean of IoU + latitude, less what the RMS distance of a surface that the method optimises is beyond 0.1 voxels; an
/// iterate that meets the conditions is before any that does not, and before all one with which the run ends.
struct IterationState {
  int iteration = -1;  // not begun
  double best = std::numeric_limits<double>::lowest();
  int best_at = 0;
  std::vector<Slab> best_light;  // empty: not kept
  std::vector<double> latitude;  // after each iteration, the largest so far
  double began_s = 0;            // with iteration 0; known where there is a deadline
};

/// Runs the method on one pass. The light of the best merit is kept where there is patience, unless the method asks for
/// more than the nominal doses show. When iterate.g is not empty it is where the method starts from; a run
/// that has begun resumes from where it was interrupted (method and iterate as they were), as if it had not been.
Outcome run_method(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                   Iterate& iterate, IterationState& run, const Watch& watch = {}, const Pause& pause = {});
/// The light of the best iterate and its dose take the place of the last one's; false where that is the best, or none
/// was kept.
bool return_to_best(const Problem& problem, const light::Operator& light, IterationState& run, Iterate& iterate);
/// From the start to the end.
Outcome run_method(Method& method, const Problem& problem, const light::Operator& light, const Limits& limits,
                   Iterate& iterate);

}  // namespace vam::optimize
