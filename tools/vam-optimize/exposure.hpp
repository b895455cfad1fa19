// SPDX-License-Identifier: GPL-3.0-or-later
// Exposure of the projections of vam-optimize.
#pragma once

#include <optional>

#include "model/dose/dose_metrics.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optimize/run/volume.hpp"
#include "score/exposure.hpp"
#include "session/scene.hpp"
#include "vam-optimize/options.hpp"
#include "vam-optimize/sink.hpp"
#include "verdict/verdict.hpp"

namespace vam::optimize_tool {

/// Turns and seconds for a dose with these metrics, where `peak` intensity (or optimize.full_scale) is full grey; those
/// of --turns for light that completes a dose. None where the resin's critical dose is not known or takes a million
/// turns, nothing is lit, or frames are shown once.
[[nodiscard]] std::optional<score::ExposurePlan> plan_of(const model::DoseMetrics& doses, double peak,
                                                         const model::Printer& printer, const model::StackInfo& info,
                                                         const Options& options);

struct Printing {
  std::optional<score::ExposurePlan> plan;
  double full_scale = 0;              // value at full intensity
  std::optional<double> of_exposure;  // dose that sets the resin, where the exposure is stated or the dose has a scale
  verdict::PrintThreshold threshold;  // the same, or without it
  double seconds = 0;                 // during which the dose diffuses
};

/// Plans the exposure, finishes the stack by it, and makes the figures of `outcome` those of the frames as they are
/// shown: in the grey levels of --bits, which are rounded for the first plan, and with the diffusion of that time;
/// those of --slices stay. Warns where the light compensates for another diffusion.
[[nodiscard]] Printing judge_printed(optimize::VolumeTask& task, const light::Operator& light, Sink& sink,
                                     const session::Scene& scene, const model::StackInfo& info, const Options& options,
                                     optimize::VolumeOutcome& outcome);

/// Whether the stack states its exposure: not a piece, as the plan is one of the whole part, unless --turns gives it.
[[nodiscard]] bool states_exposure(const model::StackInfo& info, const model::Printer& printer, const Options& options);

/// The value that, full grey for so many showings of the frames, gives the critical dose where the relative dose is the
/// threshold.
[[nodiscard]] double full_grey(const model::Printer& printer, double showings, const Options& options);

/// The dose that sets the resin where no exposure can put it elsewhere: what completes a dose has a scale.
[[nodiscard]] std::optional<double> fixed_threshold(const Options& options);

}  // namespace vam::optimize_tool
