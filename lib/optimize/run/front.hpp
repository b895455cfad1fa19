// SPDX-License-Identifier: GPL-3.0-or-later
// The front of duration against window: what the print is at each limit of the intensity while it is raised.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/image.hpp"
#include "light/operators/operator.hpp"
#include "model/dose/dose_metrics.hpp"
#include "optimize/methods/method.hpp"

namespace vam::optimize {

/// The print at one limit, in the grey levels of the projector, at the printing threshold.
struct FrontPoint {
  double max_intensity = 0;  // the limit
  double peak = 0;           // largest intensity shown
  double efficiency = 0;     // mean over largest intensity
  model::DoseMetrics metrics;
  std::optional<double> latitude_tolerances;  // of all scenarios and the nominal light together, if there are any
};
/// Frames as the projector shows them.
using Show = std::function<std::vector<Image>(std::vector<Image>)>;

/// All that the table of --tradeoff needs.
void exchange(Archive& archive, std::vector<FrontPoint>& front);

/// What the iterate of a pass that holds all slices prints now; `light` with its blur.
[[nodiscard]] FrontPoint front_point(const Problem& problem, const light::Operator& light, double max_intensity,
                                     Iterate state, const Scenarios* scenarios, const Show& show);

}  // namespace vam::optimize
