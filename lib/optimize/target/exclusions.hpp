// SPDX-License-Identifier: GPL-3.0-or-later
// Voxels that inserts exclude from the optimisation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/operators/operator.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Voxels that an insert fills to a half or more are neither part nor void.
void exclude(Problem& problem, std::span<const Slab> inserts);

/// Voxels of part or void that no light can reach are left out too; returns how many of the part's there were in each
/// slice.
[[nodiscard]] std::vector<std::int64_t> exclude_dark(Problem& problem, const light::Operator& light);

}  // namespace vam::optimize
