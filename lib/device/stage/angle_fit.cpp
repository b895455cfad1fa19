// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/angle_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vam::device {

void AngleFit::add(const AngleSample& sample) {
  samples_.push_back(sample);
  while (samples_.front().t_s < sample.t_s - window_s_) samples_.pop_front();
  solved_ = false;
}

bool AngleFit::ready() const {
  return samples_.size() >= 3 && samples_.back().t_s - samples_.front().t_s >= 0.25 * window_s_;
}

void AngleFit::solve() const {
  if (solved_) return;
  constexpr double least_sigma_deg = 1e-6;
  std::vector<stats::Measured> times, angles;
  const double origin_s = samples_.front().t_s;  // keeps the sums small
  for (const auto& s : samples_) {
    const double sigma_deg = std::max(s.sigma_deg, least_sigma_deg);
    times.push_back({s.t_s - origin_s, sigma_deg, 1});
    angles.push_back({s.angle_deg, sigma_deg, 1});
  }
  const double mean_s = stats::weighted_mean(times).value;
  mean_t_s_ = origin_s + mean_s;
  std::vector<double> from_mean_s;
  for (const auto& time : times) from_mean_s.push_back(time.value - mean_s);
  line_ = stats::weighted_line(from_mean_s, angles);  // about the mean time its two values do not depend on each other
  solved_ = true;
}

AngleSample AngleFit::at(double t_s) const {
  solve();
  const double dt = t_s - mean_t_s_;
  return {t_s, line_.at_zero.value + line_.slope.value * dt, std::hypot(line_.at_zero.sigma, line_.slope.sigma * dt)};
}

double AngleFit::speed_deg_s() const {
  solve();
  return line_.slope.value;
}

double AngleFit::speed_sigma_deg_s() const {
  solve();
  return line_.slope.sigma;
}

}  // namespace vam::device
