// SPDX-License-Identifier: GPL-3.0-or-later
// The one-sided loss: every voxel's dose should stay within bounds; inside them there is no penalty [physics §6].
#pragma once

#include <cmath>
#include <limits>

#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// The fraction of its band that a grey voxel is constrained to at first: a penalty leaves most misses just outside its
/// bounds.
inline constexpr float aimed_share = 0.8F;

/// The doses that a voxel may have: void at most window.low, part at least window.high, a grey voxel those whose
/// response is within that share of its tolerance of the target.
inline DoseRange bounds(const Problem& problem, const DoseWindow& window, std::size_t s, std::size_t i,
                        float share = aimed_share) {
  constexpr float without_limit = std::numeric_limits<float>::infinity();
  const Label label = problem.labels[s][i];
  if (!is_constrained(label)) return {-without_limit, without_limit};
  if (problem.demands.grey) {
    return problem.demands.curve.doses(problem.target[s].values[i], share * problem.tolerance_at(s, i));
  }
  if (label == Label::void_) return {-without_limit, static_cast<float>(window.low)};
  return {static_cast<float>(window.high), without_limit};
}

/// Slope of (w/2) miss(D)^2, w the voxel's weight.
inline float slope(const Problem& problem, const DoseWindow& window, std::size_t s, std::size_t i, float dose) {
  return problem.weight_at(s, i) * bounds(problem, window, s, i).miss(dose);
}

/// The loss w |excess|^p of a voxel, excess what its dose (or response) is beyond its bounds, signed [PM21; BCLP24].
inline float power_loss(float weight, float excess, double power) {
  const float over = std::abs(excess);
  return over > 0 ? weight * std::pow(over, static_cast<float>(power)) : 0.0F;
}

/// Its derivative by the dose; steepness is that of the excess.
inline float power_slope(float weight, float excess, double power, float steepness = 1) {
  if (excess == 0) return 0;
  const auto p = static_cast<float>(power);
  return weight * std::copysign(p * std::pow(std::abs(excess), p - 1) * steepness, excess);
}

}  // namespace vam::optimize
