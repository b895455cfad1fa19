// SPDX-License-Identifier: GPL-3.0-or-later
// Response curve M of the resin, degree of cure against dose, in the losses of cal and of the band-constraint norm
// [BCLP24].
#pragma once

#include <utility>
#include <vector>

namespace vam::optimize {

/// Doses from low to high; a dose outside misses by its distance.
struct DoseRange {
  float low;
  float high;
  [[nodiscard]] float miss(float dose) const { return dose < low ? dose - low : dose > high ? dose - high : 0.0F; }
};

/// A curve that never falls, from dose (relative) to response, 0 liquid, 1 cured.
class CureCurve {
 public:
  /// M(D) = D: the response is the dose.
  [[nodiscard]] static CureCurve linear();
  /// 0 up to low, 1 from high on. In between it is unknown, so it has no slope to follow; taken as straight.
  [[nodiscard]] static CureCurve step(double low, double high);
  /// M(D) = 1 / (1 + e^{(d_t - D)/gamma}): d_t the dose of response 1/2, gamma the softness, above 0.
  [[nodiscard]] static CureCurve logistic(double threshold, double softness);
  /// Straight between points (dose, response), level beyond the first and the last. Throws Fault::data unless there are
  /// two points, doses rise, and responses do not fall.
  [[nodiscard]] static CureCurve table(const std::vector<std::pair<double, double>>& points);

  [[nodiscard]] float response(float dose) const;
  /// dM/dD.
  [[nodiscard]] float slope(float dose) const;
  /// The integral of M up to the dose, short of a constant.
  [[nodiscard]] float area(float dose) const;
  /// The doses whose response is within `tolerance` of `wanted`, without a limit where the curve has none. Where no
  /// dose does it, the nearest.
  [[nodiscard]] DoseRange doses(float wanted, float tolerance) const;
  /// A step: misses are measured in dose.
  [[nodiscard]] bool is_step() const { return kind_ == CurveKind::step; }

 private:
  enum class CurveKind { linear, step, logistic, table };
  struct CurvePoint {
    float dose, response, area;
  };
  CureCurve(CurveKind kind, double threshold, double softness)
      : kind_(kind), threshold_(threshold), softness_(softness) {}
  [[nodiscard]] std::size_t piece(float dose) const;
  CurveKind kind_;
  double threshold_, softness_;
  std::vector<CurvePoint> points_;
};

}  // namespace vam::optimize
