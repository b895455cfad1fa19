// SPDX-License-Identifier: GPL-3.0-or-later
// The scale of what has been optimised: where the printing threshold lies in its doses.
#pragma once

#include "light/operators/operator.hpp"
#include "optimize/methods/method.hpp"

namespace vam::optimize {

/// Slices that print at one exposure: each by itself, or all of a pass.
enum class ExposureGroup { slice, pass };

/// Scales a pass, slice by slice or as one, so that the threshold lies in the middle of its process window, or, where
/// it is asked for on the surface, no more than puts it in the middle half; with scenarios, in the middle between the
/// largest void and the least part dose of any of them or of the nominal light. No light exceeds max_intensity (0: no
/// limit).
void bring_to_threshold(const Problem& problem, const light::Operator& light, ExposureGroup group, double max_intensity,
                        const Scenarios* scenarios, Iterate& state);

/// Doses of the nominal light, state.dose, and of every scenario's.
[[nodiscard]] model::DoseStatistics statistics_of_all(const Scenarios& scenarios, const Problem& problem,
                                                      const Iterate& state);

}  // namespace vam::optimize
