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

/// State that passes hand on, beside their projections.
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

/// The printers that a pass is optimised for: the nominal one, and those that deviate from it, if any.
struct PassPrinters {
  PassSetup setup;
  std::optional<Scenarios> scenarios = {};

  [[nodiscard]] const Scenarios* all() const { return scenarios ? &*scenarios : nullptr; }
};

/// The method and the light that the pass starts from. Its part in the shadow of inserts is counted.
void begin(RunState& run, const Pass& pass, const PassSetup& setup, PassState& work);
/// The iterations of a pass, up to its best light; false when it was interrupted.
[[nodiscard]] bool iterate(RunState& run, const Pass& pass, const PassPrinters& printers, PassState& work,
                           Progress& progress);
/// Adds the finished pass to the outcome. Its light is scaled to the threshold.
void finish(RunState& run, const Pass& pass, const PassPrinters& printers, PassState& work);
/// Writes slab by slab: images are several times as large as the light in them, and take the memory of dose and method.
void hand_out(const RunState& run, const Pass& pass, const light::Operator& light, PassState work,
              OutputQueue& outputs);

}  // namespace vam::optimize
