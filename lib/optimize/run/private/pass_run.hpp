// SPDX-License-Identifier: GPL-3.0-or-later
// A pass of a run: its iterations, and what becomes of its light.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/image.hpp"
#include "base/log/progress.hpp"
#include "model/dose/dose_metrics.hpp"
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/private/pass_setup.hpp"
#include "optimize/run/private/run_totals.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// Keeps the projections of a job until its last slice has been written.
class OutputQueue {
 public:
  using Write = std::function<void(int k, const Image& image)>;  // takes the slices asked for, in order

  /// The jobs are referred to.
  OutputQueue(const Jobs& jobs, Write write)
      : jobs_(jobs),
        write_(std::move(write)),
        next_(jobs.passes.front().first),
        peaks_(jobs.schedule.job_of_slice.size()) {}

  /// The pass that the next projections are of; null: all are finished.
  [[nodiscard]] const Pass* open() const { return pass_ < jobs_.passes.size() ? &jobs_.passes[pass_] : nullptr; }
  /// How many of its jobs are not finished.
  [[nodiscard]] int left() const { return open() == nullptr ? 0 : open()->last - next_; }
  /// The projections of its next jobs; every slice whose turn has come is written. Throws Fault::data for values that
  /// are not finite.
  void take(std::vector<Image> images);
  /// Efficiency and peak of all that has been written.
  [[nodiscard]] double efficiency() const { return efficiency_.value(); }
  [[nodiscard]] double peak() const { return efficiency_.max; }
  /// Peak of each slice; 0 of those that are not selected.
  [[nodiscard]] const std::vector<float>& peaks() const { return peaks_; }

 private:
  void write_ready();

  const Jobs& jobs_;
  Write write_;
  std::size_t pass_ = 0;
  int next_;  // job
  std::map<int, Image> held_;
  int slices_ = 0;  // dealt with
  model::LightEfficiency efficiency_;
  std::vector<float> peaks_;
};

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
