// SPDX-License-Identifier: GPL-3.0-or-later
// Optimisation of projections that tolerate deviations of the printer.
#pragma once

#include <memory>

#include "optimize/methods/method.hpp"

namespace vam::optimize {

/// apg on the mean loss of the printer as set and of scenarios [physics §6]: first steps in the nominal light alone,
/// then steps on the nominal's and a pair's exact gradients, another pair each time. Needs set_scenarios() before the
/// first step.
[[nodiscard]] std::unique_ptr<Method> make_robust(const MethodOptions& options);

}  // namespace vam::optimize
