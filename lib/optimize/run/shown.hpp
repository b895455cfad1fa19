// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of the frames as they are written, in the projector's grey levels.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/image.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// The dose at which the exposure that is planned for these doses sets the resin.
using AimedDose = std::function<double(const model::DoseMetrics& doses)>;

/// Seconds that the print of a light with these figures takes.
using PrintSeconds = std::function<double(const VolumeOutcome& outcome)>;

/// The prints of resins that set at these doses, of frames as in judge_shown(): figures, pieces, and wrong voxels slice
/// by slice.
[[nodiscard]] std::vector<VolumeOutcome> prints_at(const VolumeTask& task, const light::Operator& light,
                                                   std::span<const Image> frames, std::span<const double> doses);

/// Makes the figures, demands and intensities of `outcome` those of `frames`: one image a slice, columns x angles,
/// fluence; slices without one are dark. What gels outside the part's box is counted at the dose aimed at. The
/// surface's deviation is not known then. Memory: as a pass of optimise().
void judge_shown(const VolumeTask& task, const light::Operator& light, std::span<const Image> frames,
                 const AimedDose& aimed, VolumeOutcome& outcome);

/// While the print takes another time than the dose has diffused for: makes the blur of `task` that of that time, and
/// judges `frames` again. Returns that time.
double judge_exposed(VolumeTask& task, const light::Operator& light, std::span<const Image> frames,
                     const AimedDose& aimed, const PrintSeconds& seconds, const std::function<double(double)>& blur_px,
                     VolumeOutcome& outcome);

}  // namespace vam::optimize
