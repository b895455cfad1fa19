// The one loop: step, look, stop.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "model/conditions.hpp"
#include "optimize/method.hpp"

namespace vam::optimize {

struct Limits {
  int iterations = 0;
  std::vector<model::Condition> until;  // stop when all hold; names as in SliceFigures::names()
  int patience = 10;                    // stop when nothing improved in so many iterations; 0 = never
  double least_gain = 1e-4;             // an improvement of the mean of IoU + PW smaller than this is none
};

struct Outcome {
  int iterations = 0;
  std::string reason;  // "iterations", "goal" or "no progress"
};

/// Called with iteration 0 (the start) and after every step; one entry per slice of the pass.
using Watch = std::function<void(int iteration, const std::vector<model::DoseMetrics>& slices)>;

/// Runs the method on one pass. When iterate.g is not empty it is where the method starts from.
Outcome iterate(Method& method, const Problem& problem, const Operator& light, const Limits& limits, Iterate& iterate,
                const Watch& watch = {});

}  // namespace vam::optimize
