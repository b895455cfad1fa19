// SPDX-License-Identifier: GPL-3.0-or-later
// The projections of finished jobs, handed out slice by slice.
#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "base/image.hpp"
#include "model/dose/dose_metrics.hpp"
#include "optimize/run/private/jobs.hpp"

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

}  // namespace vam::optimize
