// SPDX-License-Identifier: GPL-3.0-or-later
// The course of the stage during a turn that has ended, fitted to all of its samples: late replies scatter, and a live
// prediction can use past samples only.
#pragma once

#include <cstddef>
#include <vector>

#include "base/stats/curve_fit.hpp"

namespace vam::metrology {

/// One answer of the stage.
struct StagePoint {
  double t_s = 0;
  double angle_deg = 0;
  double sigma_deg = 0;
};

/// A line in time with a bend every 2 s, as a speed may wander, and up to 24 harmonics of the turn, by weighted least
/// squares.
class StageCourse {
 public:
  /// Points of a stage that keeps its speed, increasing in time. Throws Fault::data when they are too few.
  explicit StageCourse(const std::vector<StagePoint>& points);
  /// Also a second beyond the first and last point.
  [[nodiscard]] double angle_deg(double t_s) const;
  /// Standard deviation of sum_i weight_i angle_deg(time_i): what these angles have in common does not average out.
  [[nodiscard]] double sigma_deg(const std::vector<double>& time_s, const std::vector<double>& weight) const;

 private:
  [[nodiscard]] std::vector<double> parts(double t_s, double angle_deg) const;  // of each unknown at that place
  double begin_s_ = 0, bend_s_ = 1;
  std::size_t bends_ = 2;  // ends included
  std::size_t harmonics_ = 0;
  stats::CurveFit fit_;
};

}  // namespace vam::metrology
