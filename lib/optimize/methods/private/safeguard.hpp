// SPDX-License-Identifier: GPL-3.0-or-later
// Restores the previous iterate of slices whose loss has increased.
#pragma once

#include <vector>

#include "optimize/methods/method.hpp"

namespace vam::optimize {

/// Slices whose loss rose go back to where they were before; the loss of the others becomes the new one. Returns 1 for
/// those that went back, 0 for the others.
PerSlice go_back(Iterate& now, const Iterate& before, PerSlice& loss, const PerSlice& loss_now);

/// For each slice the sum over all, if light couples slices; else unchanged.
[[nodiscard]] PerSlice pooled(PerSlice values, const light::Operator& light);
/// The same with the largest.
[[nodiscard]] PerSlice largest_pooled(PerSlice values, const light::Operator& light);

/// Clips the light to at most `peak`; returns whether any was above.
bool clip_above(std::vector<Slab>& g, float peak);
/// Clips the light to at most `peak`; its dose follows. Losses are compared with that of the start, so it must be
/// allowed itself.
void enter_bounds(const Problem& problem, const light::Operator& light, float peak, Iterate& iterate);

/// Largest value that light may take: options.max_intensity as a sinogram value, or no limit when that is 0.
[[nodiscard]] float largest_light(const MethodOptions& options, const light::Operator& light);

}  // namespace vam::optimize
