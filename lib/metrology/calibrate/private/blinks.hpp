// SPDX-License-Identifier: GPL-3.0-or-later
// What exposures see of a screen that blinks, and which latencies they cannot tell apart [physics §10].
#pragma once

#include <cstddef>
#include <vector>

#include "metrology/calibrate/latency.hpp"

namespace vam::metrology {

/// During which the light comes or goes, and the width of stretches of latencies that may stay open. Of a light that
/// comes at once or by a time constant of up to 1.5 ms the moment is found all the same.
inline constexpr double rise_s = 0.001;

/// The light of a screen that blinks, 0 to 1, as a running integral.
class Blinks {
 public:
  explicit Blinks(const BlinkScan& scan);
  /// The part of each exposure during which the light, delayed, was on.
  [[nodiscard]] std::vector<double> lit_parts(double latency_s) const;

 private:
  [[nodiscard]] double integral(double t_s) const;        // of the light
  [[nodiscard]] double twice_integral(double t_s) const;  // of that with sudden changes

  const BlinkScan& scan_;
  double origin_s_;
  std::vector<double> change_s_;                        // when it comes and goes in turn, since the origin
  std::vector<double> lit_before_s_, twice_before_s2_;  // the integral of sudden changes until then, and its own
};

/// A stretch of latencies for which no exposure meets a change of the light: all of it fits alike.
struct Stretch {
  double from_s = 0, to_s = 0;
  [[nodiscard]] double width_s() const { return to_s - from_s; }
};

/// The widest that comes within rise_s of the latency; of no width where exposures meet changes all around it.
[[nodiscard]] Stretch unseen_stretch(const BlinkScan& scan, double latency_s);

}  // namespace vam::metrology
