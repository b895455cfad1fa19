// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/cure_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::optimize {

namespace {
constexpr float without_limit = std::numeric_limits<float>::infinity();
}

CureCurve CureCurve::linear() { return {CurveKind::linear, 0, 1}; }

CureCurve CureCurve::step(double low, double high) {
  CureCurve curve = table({{low, 0}, {high, 1}});
  curve.kind_ = CurveKind::step;
  return curve;
}

CureCurve CureCurve::logistic(double threshold, double softness) { return {CurveKind::logistic, threshold, softness}; }

CureCurve CureCurve::table(const std::vector<std::pair<double, double>>& points) {
  if (points.size() < 2) throw Error{Fault::data, "a response curve needs at least two points"};
  CureCurve curve(CurveKind::table, 0, 1);
  for (const auto& [dose, response] : points) {
    CurvePoint point{static_cast<float>(dose), static_cast<float>(response), 0};
    if (!curve.points_.empty()) {
      const CurvePoint& last = curve.points_.back();
      if (!(point.dose > last.dose) || point.response < last.response) {
        throw Error{Fault::data, "the response curve falls back after dose " + format_number(last.dose) +
                                     " (response " + format_number(last.response) + ") at dose " + format_number(dose) +
                                     " (response " + format_number(response) +
                                     "); doses must rise and responses not fall"};
      }
      point.area = last.area + 0.5F * (point.response + last.response) * (point.dose - last.dose);
    }
    curve.points_.push_back(point);
  }
  return curve;
}

/// The piece that begins at points_[i] and holds the dose; 0 before the first, size - 1 after the last point.
std::size_t CureCurve::piece(float dose) const {
  const auto above = std::upper_bound(points_.begin(), points_.end(), dose,
                                      [](float value, const CurvePoint& point) { return value < point.dose; });
  return above == points_.begin() ? 0 : static_cast<std::size_t>(above - points_.begin()) - 1;
}

float CureCurve::slope(float dose) const {
  if (kind_ == CurveKind::linear) return 1.0F;
  if (kind_ == CurveKind::logistic) {
    const float m = response(dose);
    return m * (1.0F - m) / static_cast<float>(softness_);
  }
  const std::size_t i = piece(dose);
  if (dose < points_[0].dose || i + 1 == points_.size()) return 0.0F;
  return (points_[i + 1].response - points_[i].response) / (points_[i + 1].dose - points_[i].dose);
}

float CureCurve::response(float dose) const {
  if (kind_ == CurveKind::linear) return dose;
  if (kind_ == CurveKind::logistic) {
    return 1.0F / (1.0F + std::exp((static_cast<float>(threshold_) - dose) / static_cast<float>(softness_)));
  }
  const CurvePoint& from = points_[piece(dose)];
  return from.response + slope(dose) * (dose - from.dose);
}

float CureCurve::area(float dose) const {
  if (kind_ == CurveKind::linear) return 0.5F * dose * dose;
  if (kind_ == CurveKind::logistic) {  // gamma log(1 + e^x), without overflow
    const auto gamma = static_cast<float>(softness_);
    const float x = (dose - static_cast<float>(threshold_)) / gamma;
    return gamma * (std::max(x, 0.0F) + std::log1p(std::exp(-std::abs(x))));
  }
  const CurvePoint& from = points_[piece(dose)];
  return from.area + 0.5F * (from.response + response(dose)) * (dose - from.dose);
}

DoseRange CureCurve::doses(float wanted, float tolerance) const {
  const float least = wanted - tolerance;
  const float most = wanted + tolerance;
  if (kind_ == CurveKind::linear) return {least, most};
  if (kind_ == CurveKind::logistic) {
    const auto inverse = [this](float m) {
      if (m <= 0 || m >= 1) return m <= 0 ? -without_limit : without_limit;
      return static_cast<float>(threshold_) + static_cast<float>(softness_) * std::log(m / (1.0F - m));
    };
    return {inverse(std::min(least, 1.0F - 1e-6F)), inverse(std::max(most, 1e-6F))};
  }
  const auto between = [](const CurvePoint& a, const CurvePoint& b, float m) {
    return a.dose + (m - a.response) / (b.response - a.response) * (b.dose - a.dose);
  };
  DoseRange bounds{-without_limit, without_limit};
  if (least > points_.front().response) {  // the lowest dose with at least `least`
    const auto at =
        std::find_if(points_.begin() + 1, points_.end(), [&](const CurvePoint& p) { return p.response >= least; });
    bounds.low = at == points_.end() ? points_.back().dose : between(at[-1], *at, least);
  }
  if (most < points_.back().response) {  // the highest dose with at most `most`
    const auto at =
        std::find_if(points_.rbegin() + 1, points_.rend(), [&](const CurvePoint& p) { return p.response <= most; });
    bounds.high = at == points_.rend() ? points_.front().dose : between(*at, at[-1], most);
  }
  return bounds;
}

}  // namespace vam::optimize
