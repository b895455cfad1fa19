// SPDX-License-Identifier: GPL-3.0-or-later
// A pass of a run: its iterations, and what becomes of its light.
#pragma once

#include <memory>
#include <optional>

#include "base/log/progress.hpp"
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/private/output_queue.hpp"
#include "optimize/run/private/pass_setup.hpp"
#include "optimize/run/private/run_totals.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// What passes leave behind, beside their projections.
struct RunState {
  const VolumeTask& task;
  const light::Operator& light;
  const Jobs& jobs;
  double first_limit = 0;  // of the intensity
  RunTotals totals = {};
  VolumeOutcome outcome = {};  // filled in pass by pass; the totals has what is of all of them
};

/// A pass while it is worked on.
struct PassState {
  Iterate state;
  Search search;
  std::unique_ptr<Method> method;  // null: it has not begun
};

/// What a pass is optimised for: the printer as set, and those off their settings, if any.
struct Faced {
  PassSetup setup;
  std::optional<Scenarios> scenarios = {};

  [[nodiscard]] const Scenarios* all() const { return scenarios ? &*scenarios : nullptr; }
};

/// The method and the light that the pass starts from. Its part in the shadow of inserts is counted.
void begin(RunState& run, const Pass& pass, const PassSetup& setup, PassState& work);
/// The iterations of a pass, up to its best light; false when it was interrupted.
[[nodiscard]] bool iterate(RunState& run, const Pass& pass, const Faced& faced, PassState& work, Progress& progress);
/// What the finished pass adds to the outcome. Its light is brought to the threshold.
void finish(RunState& run, const Pass& pass, const Faced& faced, PassState& work);
/// Slab by slab: images are several times as large as the light in them, and take the memory of dose and method.
void hand_out(const RunState& run, const Pass& pass, const light::Operator& light, PassState work,
              OutputQueue& outputs);

}  // namespace vam::optimize
