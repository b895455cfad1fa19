// SPDX-License-Identifier: GPL-3.0-or-later
// How long a step may be, from the operator alone.
#pragma once

#include "light/operators/operator.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Largest eigenvalue of A* P A inside the circle (P the preconditioner), by power iteration from a fixed start, with
/// 5 % to spare: a gradient step of 1 / lambda is then safe.
[[nodiscard]] double largest_eigenvalue(const light::Operator& light, const Problem& problem);

}  // namespace vam::optimize
