// SPDX-License-Identifier: GPL-3.0-or-later
// The stage's angle as a straight line in time, fitted to its latest samples: what the angle is now and will be at the
// next flip.
#pragma once

#include <deque>

#include "base/stats/measured.hpp"
#include "device/os/angle_sample.hpp"

namespace vam::device {

/// Weighted least squares over the samples of the last window_s seconds.
class AngleFit {
 public:
  explicit AngleFit(double window_s = 1.0) : window_s_(window_s) {}
  void add(const AngleSample& sample);
  void clear() { samples_.clear(); }
  /// At least three samples over at least a quarter of the window.
  [[nodiscard]] bool ready() const;
  /// Both need ready(). sigma_deg is the fit's own uncertainty at t_s.
  [[nodiscard]] AngleSample at(double t_s) const;
  [[nodiscard]] double speed_deg_s() const;
  [[nodiscard]] double speed_sigma_deg_s() const;

 private:
  void solve() const;
  double window_s_;
  std::deque<AngleSample> samples_;
  mutable bool solved_ = false;
  mutable double mean_t_s_ = 0;
  mutable stats::WeightedLine line_;  // over the time from there
};

}  // namespace vam::device
