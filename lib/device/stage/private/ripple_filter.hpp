// SPDX-License-Identifier: GPL-3.0-or-later
// The angle of a stage whose speed ripples with its angle, as that of gears and motors does: a straight line in time
// and harmonics of the turn, both followed sample by sample.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "device/os/angle_sample.hpp"
#include "device/stage/round_trips.hpp"

namespace vam::device {

/// A Kalman filter. The line's speed may wander by a thousandth of itself in a second; the harmonics stay as they are
/// learned, the first turn being enough, so that the run-up teaches them. Those that do not stand out of the noise are
/// left out after a turn: a stage has few, and 24 of them would follow the noise. After a jump the line is found anew.
class RippleFilter {
 public:
  void add(const AngleSample& sample);
  /// At least three samples over a quarter of a second.
  [[nodiscard]] bool ready() const;
  /// Needs ready(). sigma_deg is the filter's own uncertainty at t_s.
  [[nodiscard]] AngleSample at(double t_s) const;
  /// Of the line, without ripple. Needs ready().
  [[nodiscard]] double speed_deg_s() const;

 private:
  static constexpr std::size_t harmonics = 24;  // of the turn: periods down to 15 degrees
  static constexpr std::size_t size = 2 + 2 * harmonics;
  using Vector = std::array<double, size>;

  // What is known of the line's angle, its speed, then cosine and sine of each harmonic, in degrees.
  struct StateEstimate {
    Vector mean{};
    std::array<Vector, size> covariance{};

    [[nodiscard]] Vector covariance_with(const Vector& seen) const;
    [[nodiscard]] double expected(const Vector& seen) const;
    [[nodiscard]] double variance(const Vector& seen) const;
    void observe(const Vector& seen, double value, double noise);
    /// The part at a place is 0 but for so much.
    void observe_zero(std::size_t place, double noise);

   private:
    void correct(const Vector& common, double total, double off);
  };

  void begin(const AngleSample& sample);
  void advance(double to_s);
  [[nodiscard]] static Vector seen_at(double angle_deg);
  [[nodiscard]] const StateEstimate& without_noise() const;

  int count_ = 0;
  double first_s_ = 0, t_s_ = 0;
  double first_deg_ = 0, farthest_deg_ = 0;             // of which the harmonics have been seen
  StateEstimate all_;                                   // with every harmonic that may be
  mutable std::optional<StateEstimate> without_noise_;  // with those that stand out; made when asked for
};

/// The share of late answers, from what the filter expects, whose samples all are middles; then adds that of the
/// sample timed last.
void learn(RoundTrips& trips, RippleFilter& middles);

}  // namespace vam::device
