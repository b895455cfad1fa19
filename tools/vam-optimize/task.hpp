// SPDX-License-Identifier: GPL-3.0-or-later
// The optimisation task, from inputs and options.
#pragma once

#include "model/stack.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/run/yield.hpp"
#include "vam-optimize/inputs.hpp"
#include "vam-optimize/light.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Of the projections that come out.
[[nodiscard]] model::StackInfo stack_info(const Scene& scene, const io::SparseVolume& target, const cli::App& app,
                                          const Options& options);

/// Without its output. Scene, inputs and options must outlive the task. Only options.how is read later, when a pass
/// begins; all else is copied here.
[[nodiscard]] optimize::VolumeTask make_task(const Scene& scene, const Inputs& in, const Options& options);

/// The printers to judge the frames with, of --robust.
[[nodiscard]] optimize::Trial make_trial(const Scene& scene, const model::StackInfo& info, const Options& options);

}  // namespace vam::optimize_tool
