// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/angle_fit.hpp"

#include <algorithm>
#include <cmath>

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
  double sum = 0;
  double sum_t = 0;
  double sum_angle = 0;
  const auto weight = [](const AngleSample& s) { return 1 / std::max(s.sigma_deg * s.sigma_deg, 1e-12); };
  const double origin_s = samples_.front().t_s;  // keeps the sums small
  for (const auto& s : samples_) {
    sum += weight(s);
    sum_t += weight(s) * (s.t_s - origin_s);
    sum_angle += weight(s) * s.angle_deg;
  }
  mean_t_s_ = origin_s + sum_t / sum;
  mean_deg_ = sum_angle / sum;
  double tt = 0;
  double ta = 0;
  for (const auto& s : samples_) {
    const double dt = s.t_s - mean_t_s_;
    tt += weight(s) * dt * dt;
    ta += weight(s) * dt * (s.angle_deg - mean_deg_);
  }
  slope_ = ta / tt;
  // The scatter about the line, when it is larger than the samples' own sigmas say, widens the uncertainty.
  double chi2 = 0;
  for (const auto& s : samples_) {
    const double residual = s.angle_deg - mean_deg_ - slope_ * (s.t_s - mean_t_s_);
    chi2 += weight(s) * residual * residual;
  }
  const double widening = std::max(1.0, chi2 / static_cast<double>(samples_.size() - 2));
  slope_variance_ = widening / tt;
  mean_variance_ = widening / sum;
  solved_ = true;
}

AngleSample AngleFit::at(double t_s) const {
  solve();
  const double dt = t_s - mean_t_s_;
  return {t_s, mean_deg_ + slope_ * dt, std::sqrt(mean_variance_ + slope_variance_ * dt * dt)};
}

double AngleFit::speed_deg_s() const {
  solve();
  return slope_;
}

double AngleFit::speed_sigma_deg_s() const {
  solve();
  return std::sqrt(slope_variance_);
}

}  // namespace vam::device
