// SPDX-License-Identifier: GPL-3.0-or-later
// The optimisation task, from inputs and options.
#pragma once

#include <optional>

#include "model/stack.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/run/yield.hpp"
#include "session/job_volumes.hpp"
#include "session/scene.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Of the optimised projections.
[[nodiscard]] model::StackInfo stack_info(const session::Scene& scene, const io::SparseVolume& target,
                                          const cli::App& app, const Options& options);

/// Those of --slices, in shares of whole passes where it names one; none: all. Throws Fault::data where the stack has
/// too few.
[[nodiscard]] std::optional<model::ImageRange> slices_of(const model::StackInfo& whole, const Options& options);

/// Of these slices. Drops output options from the history, so that joined pieces are byte-identical to the whole.
[[nodiscard]] model::StackInfo written_info(const model::StackInfo& whole,
                                            const std::optional<model::ImageRange>& slices, const cli::App& app,
                                            const Options& options);

/// Throws Fault::usage where --slices asks for a part of slices that are all optimised together.
void require_independent(const optimize::VolumeTask& task, const light::Operator& light);

/// Without its output. Scene, inputs and options must outlive the task. Only options.how is read later, when a pass
/// begins; all else is copied here.
[[nodiscard]] optimize::VolumeTask make_task(const session::Scene& scene, const session::JobVolumes& in,
                                             const Options& options);

/// The printers to judge the frames with, of --robust and --tolerances, whose doses diffuse for so long. `threshold`:
/// that of the print; prints: by its verdict, whose ends are found. Scene and options must outlive it.
[[nodiscard]] optimize::Trial make_trial(const session::Scene& scene, double seconds, double threshold, bool prints,
                                         const Options& options);

}  // namespace vam::optimize_tool
