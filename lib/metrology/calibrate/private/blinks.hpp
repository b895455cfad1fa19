// SPDX-License-Identifier: GPL-3.0-or-later
// Exposures of a screen that blinks, and the latencies that they cannot tell apart [physics §10].
#pragma once

#include <vector>

#include "metrology/calibrate/latency.hpp"

namespace vam::metrology {

/// Width of stretches of latencies that may stay open.
inline constexpr double unsure_s = 0.001;

/// The light of a screen that blinks, 0 to 1, which approaches what is shown exponentially, as a running integral.
class Blinks {
 public:
  /// rise_s: the time constant.
  Blinks(const BlinkScan& scan, double rise_s);
  /// The part of each exposure during which the light was on. The latency is that of the light's middle: its delay and
  /// the time constant.
  [[nodiscard]] std::vector<double> lit_parts(double latency_s) const;

 private:
  [[nodiscard]] double integral(double t_s) const;  // of the light

  const BlinkScan& scan_;
  double rise_s_;
  double origin_s_;
  std::vector<double> change_s_;              // when it comes and goes in turn, since the origin
  std::vector<double> lit_before_s_, level_;  // the integral of what is shown until then, and the light there
};

/// A stretch of latencies for which no exposure meets a change of the light: all of it fits alike.
struct Stretch {
  double from_s = 0, to_s = 0;
  [[nodiscard]] double width_s() const { return to_s - from_s; }
};

/// The widest that comes within unsure_s of the latency or while light of that time constant comes; of no width where
/// exposures meet changes all around it.
[[nodiscard]] Stretch unseen_stretch(const BlinkScan& scan, double latency_s, double rise_s);

}  // namespace vam::metrology
