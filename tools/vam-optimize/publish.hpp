// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings and reports of a finished run.
#pragma once

#include <optional>

#include "io/vdb/vdb.hpp"
#include "model/stack.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/run/yield.hpp"
#include "session/scene.hpp"
#include "vam-optimize/exposure.hpp"
#include "vam-optimize/options.hpp"
#include "verdict/verdict.hpp"

namespace vam::optimize_tool {

/// That of vam-score on the dose that vam-dose makes of the stack; of a grey target the words alone.
[[nodiscard]] verdict::Verdict verdict_of(const optimize::VolumeTask& task, const optimize::VolumeOutcome& outcome,
                                          const Printing& printing, const session::Scene& scene,
                                          const io::SparseVolume& target, const model::StackInfo& info,
                                          const Options& options);

/// Warnings on stderr; the files of --trace and --report where they are requested.
void publish(const optimize::VolumeTask& task, const optimize::VolumeOutcome& outcome, const Printing& printing,
             verdict::Verdict verdict, const std::optional<optimize::Trials>& trials, const session::Scene& scene,
             const io::SparseVolume& target, const model::StackInfo& info, const Options& options);

}  // namespace vam::optimize_tool
