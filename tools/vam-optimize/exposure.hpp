// SPDX-License-Identifier: GPL-3.0-or-later
// Exposure of the projections of vam-optimize.
#pragma once

#include <optional>

#include "model/dose/dose_metrics.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "score/exposure.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Turns and seconds for a dose with these metrics, where `peak` intensity (or optimize.full_scale) is full grey. None
/// where the resin's critical dose is not known or takes a million turns, nothing is lit, or frames are shown once.
[[nodiscard]] std::optional<score::ExposurePlan> exposure_of(const model::DoseMetrics& doses, double peak,
                                                             const model::Printer& printer,
                                                             const model::StackInfo& info, const Options& options);

/// Whether the stack states its exposure: not a piece, as the plan is one of the whole part, nor light whose exposure
/// was given with what it completes.
[[nodiscard]] bool states_exposure(const model::StackInfo& info, const model::Printer& printer, const Options& options);

/// The dose that sets the resin where no exposure can put it elsewhere: what completes a dose has a scale.
[[nodiscard]] std::optional<double> fixed_threshold(const Options& options);

/// The dose that sets the resin in that exposure, in the unit of the threshold.
[[nodiscard]] double aimed_dose(const model::DoseMetrics& doses, const Options& options);

}  // namespace vam::optimize_tool
