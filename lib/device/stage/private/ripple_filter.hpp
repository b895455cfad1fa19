// The angle of a stage whose speed ripples with its angle, as that of gears and motors does: a straight line in time
// and harmonics of the turn, both followed sample by sample.
#pragma once

#include <array>
#include <cstddef>

#include "device/stage/angle_fit.hpp"

namespace vam::device {

/// A Kalman filter. The line's speed may wander by a thousandth of itself in a second; the harmonics stay as they are
/// learned, the first turn being enough, so that the run-up teaches them. After a jump the line is found anew.
class RippleFilter {
 public:
  void add(const AngleSample& sample);
  /// At least three samples over a quarter of a second.
  [[nodiscard]] bool ready() const;
  /// Needs ready(). sigma_deg is the filter's own uncertainty at t_s.
  [[nodiscard]] AngleSample at(double t_s) const;

 private:
  static constexpr std::size_t harmonics = 24;  // of the turn: periods down to 15 degrees
  static constexpr std::size_t size = 2 + 2 * harmonics;
  using Vector = std::array<double, size>;

  void begin(const AngleSample& sample);
  void advance(double to_s);
  [[nodiscard]] static Vector seen_at(double angle_deg);
  [[nodiscard]] double ripple_deg(double angle_deg) const;
  [[nodiscard]] Vector times(const Vector& vector) const;

  int count_ = 0;
  double first_s_ = 0, t_s_ = 0;
  Vector state_{};                     // line's angle, its speed, then cosine and sine of each harmonic, in degrees
  std::array<Vector, size> spread_{};  // covariance
};

}  // namespace vam::device
