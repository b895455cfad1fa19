// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/recorded_angle_fit.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"

namespace vam::metrology {

namespace {

constexpr double from_bend_to_bend_s = 2;
constexpr std::size_t most_harmonics = 24;    // of the turn, as those that follow it live have
constexpr std::size_t points_of_unknown = 8;  // or fewer harmonics
constexpr double least_sigma_deg = 1e-4;      // an encoder's last digit

}  // namespace

StageCourse::StageCourse(const std::vector<StagePoint>& points) {
  if (points.size() < 2 * points_of_unknown || !(points.back().t_s > points.front().t_s)) {
    throw Error{Fault::data, "stage angles: " + std::to_string(points.size()) +
                                 " samples during a turn are too few; give the output of vam-stage spin"};
  }
  const double span_s = points.back().t_s - points.front().t_s;
  begin_s_ = points.front().t_s;
  bends_ = std::clamp<std::size_t>(std::lround(span_s / from_bend_to_bend_s), 1, points.size() / points_of_unknown) + 1;
  bend_s_ = span_s / static_cast<double>(bends_ - 1);
  const std::size_t left = std::max(points.size() / points_of_unknown, bends_) - bends_;
  harmonics_ = std::min(left / 2, most_harmonics);
  std::vector<double> rows;
  for (const StagePoint& point : points) {
    const auto row = parts(point.t_s, point.angle_deg);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  const auto residuals = [&](const std::vector<double>& p) {
    std::vector<double> out = stats::sums_of(rows, p);
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = (points[i].angle_deg - out[i]) / std::max(points[i].sigma_deg, least_sigma_deg);
    }
    return out;
  };
  const std::size_t unknowns = bends_ + 2 * harmonics_;
  fit_ =
      stats::fit_curve(residuals, std::vector<double>(unknowns), std::vector<double>(unknowns, 1e-3), "stage angles");
}

std::vector<double> StageCourse::parts(double t_s, double angle_deg) const {
  std::vector<double> row(bends_ + 2 * harmonics_);
  const double at = (t_s - begin_s_) / bend_s_;
  const auto last = static_cast<double>(bends_ - 2);
  const auto segment = static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, last));
  const double into = at - static_cast<double>(segment);  // below 0 and above 1 beyond the ends
  row[segment] = 1 - into;
  row[segment + 1] = into;
  for (std::size_t k = 1; k <= harmonics_; ++k) {
    const double theta = static_cast<double>(k) * angle_deg * rad_per_deg;
    row[bends_ + 2 * k - 2] = std::cos(theta);
    row[bends_ + 2 * k - 1] = std::sin(theta);
  }
  return row;
}

double StageCourse::angle_deg(double t_s) const {
  const auto line = parts(t_s, 0);
  double angle_deg = 0;
  for (std::size_t i = 0; i < bends_; ++i) angle_deg += line[i] * fit_.value[i];
  for (int pass = 0; pass < 3; ++pass) angle_deg = stats::sums_of(parts(t_s, angle_deg), fit_.value).front();
  return angle_deg;
}

double StageCourse::sigma_deg(const std::vector<double>& time_s, const std::vector<double>& weight) const {
  std::vector<double> common(bends_ + 2 * harmonics_);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const auto row = parts(time_s[i], angle_deg(time_s[i]));
    for (std::size_t k = 0; k < row.size(); ++k) common[k] += weight[i] * row[k];
  }
  return fit_.combined(common).sigma;
}

}  // namespace vam::metrology
