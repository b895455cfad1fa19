// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings and reports of a finished run.
#pragma once

#include <optional>

#include "io/vdb/vdb.hpp"
#include "model/stack.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/run/yield.hpp"
#include "score/exposure.hpp"
#include "session/scene.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Warnings on stderr; the files of --trace and --report where they are requested. threshold: the dose that sets the
/// resin; none: the exposure puts it in the window.
void publish(const optimize::VolumeTask& task, const optimize::VolumeOutcome& outcome,
             const std::optional<optimize::Trials>& trials, const session::Scene& scene, const io::SparseVolume& target,
             const std::optional<score::ExposurePlan>& plan, std::optional<double> threshold,
             const model::StackInfo& info, const Options& options);

}  // namespace vam::optimize_tool
