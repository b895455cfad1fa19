// SPDX-License-Identifier: GPL-3.0-or-later
// The projections of finished jobs, handed out slice by slice.
#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "base/image.hpp"
#include "model/dose_metrics.hpp"
#include "model/piece.hpp"
#include "optimize/target/schedule.hpp"

namespace vam::optimize {

/// Keeps the projections of a job until the last slice that it stands for has been written.
class Finished {
 public:
  using Write = std::function<void(int k, const Image& image)>;  // takes the slices asked for, in order

  Finished(const Schedule& schedule, model::ImageRange slices, Write write)
      : schedule_(schedule), asked_(slices), write_(std::move(write)) {}

  /// The projections of the jobs that follow those already taken; every slice whose turn has come is written.
  /// Throws Fault::data for values that are not finite.
  void take(std::vector<Image> images);
  /// The next job, which no slice asked for needs, is left out.
  void skip() { take(std::vector<Image>(1)); }
  /// How many have been taken.
  [[nodiscard]] int jobs() const { return jobs_; }
  /// Of all that has been written.
  [[nodiscard]] double efficiency() const { return efficiency_.value(); }
  [[nodiscard]] double peak() const { return efficiency_.max; }
  /// Of each slice; 0 of those not asked for.
  [[nodiscard]] const std::vector<float>& peaks() const { return peaks_; }

 private:
  const Schedule& schedule_;
  model::ImageRange asked_;
  Write write_;
  std::map<int, Image> held_;
  int jobs_ = 0;
  int slices_ = 0;  // dealt with
  model::LightEfficiency efficiency_;
  std::vector<float> peaks_;
};

}  // namespace vam::optimize
