// What the optimisers' tests share: parts side by side in one pass, figures out.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "light/parallel.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/run_method.hpp"

namespace parts {

inline vam::tomo::ParallelGeometry turn(int size, int angles) {
  const double centre = 0.5 * (size - 1);
  return {size, size, size, angles, centre, centre, 0, 2 * std::numbers::pi / angles, 0};
}

inline vam::optimize::Circle circle(int size) { return {0.5 * (size - 1), 0.5 * (size - 1), 0.5 * (size - 1)}; }

inline std::vector<float> stacked(const std::vector<std::vector<float>>& slices) {
  std::vector<float> all;
  for (const auto& slice : slices) all.insert(all.end(), slice.begin(), slice.end());
  return all;
}

/// Figures of each slice after so many iterations; nothing stops them early.
inline std::vector<vam::model::DoseMetrics> run(const std::vector<std::vector<float>>& slices, int size, int angles,
                                                const std::string& name, const vam::optimize::MethodOptions& options,
                                                int iterations, const vam::optimize::Demands& demands = {}) {
  const vam::light::ParallelOperator light(turn(size, angles));
  const auto all = stacked(slices);
  const auto problem =
      vam::optimize::make_problem(all.data(), static_cast<int>(slices.size()), size, size, circle(size), demands);
  const auto method = vam::optimize::make_method(name, options);
  vam::optimize::Iterate state;
  vam::optimize::run_method(*method, problem, light, {.iterations = iterations, .until = {}, .patience = 0}, state);
  return vam::optimize::metrics(state.dose, problem);
}

}  // namespace parts
