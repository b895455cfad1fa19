// SPDX-License-Identifier: GPL-3.0-or-later
// Lower bound on the ratio of void to part dose of any light: a proof by weights on the voxels.
#pragma once

#include <vector>

#include "light/operators/operator.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Weights y >= 0 on the part and z >= 0 on the void, sum z = 1, with A y <= A z for every ray. Then for all
/// light g >= 0, min_G x * sum y <= <y, A* g> <= <z, A* g> <= max_V x: no light has a smaller max_V x / min_G x than
/// sum y [physics §6].
struct Certificate {
  double least = 0;           // sum y; 0: nothing is proved
  double reached = 0;         // the smallest max_V x / min_G x on the way, by light without a limit; 0: none
  std::vector<Slab> weights;  // z in the void, -y in the part; empty when nothing is proved
};

inline constexpr int certify_iterations = 1200;  // of A and A*, as those of apg; at most
inline constexpr double proof_gap = 0.03;        // of the smallest ratio reached: nearer, the bound is not improved

/// Tries to prove that the projections g, brought to the threshold, are nearly the best. All slices of the problem
/// share the threshold. Ends when the bound is close enough to what was reached, or after this number of iterations, of
/// a single slice in parallel light twice as many. Not of grey targets.
[[nodiscard]] Certificate certify(const Problem& problem, const light::Operator& light, std::vector<Slab> g,
                                  int iterations = certify_iterations);

}  // namespace vam::optimize
