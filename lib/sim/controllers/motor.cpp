// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/controllers/motor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vam::sim {

namespace {
constexpr double step_s = 0.0005;
constexpr double ripple_period_deg = 30;
}  // namespace

double SimMotor::speed_deg_s() const {
  const double phase = 2 * std::numbers::pi * angle_deg_ / ripple_period_deg;
  return drive_deg_s_ * (1 + settings_.speed_error + settings_.ripple * std::sin(phase));
}

void SimMotor::go_to(double target_deg) {
  target_deg_ = target_deg;
  mode_ = Mode::travelling;
}

void SimMotor::set_angle(double angle_deg) {
  angle_deg_ = angle_deg;
  target_deg_ = angle_deg;
}

// The fastest speed from which the stage can still stop at the target: v^2 = 2 a s.
double SimMotor::wanted_speed_deg_s() const {
  if (mode_ != Mode::travelling) return 0;
  const double left_deg = target_deg_ - angle_deg_;
  const double stoppable = std::sqrt(2 * settings_.acceleration_deg_s2 * std::abs(left_deg));
  return std::copysign(std::min(speed_limit_deg_s_, stoppable), left_deg);
}

void SimMotor::step() {
  double limit = settings_.acceleration_deg_s2;
  if (mode_ == Mode::braking) limit = settings_.brake_deg_s2;
  if (mode_ == Mode::coasting) limit = settings_.coast_deg_s2;
  const double change = wanted_speed_deg_s() - drive_deg_s_;
  drive_deg_s_ += std::clamp(change, -limit * step_s, limit * step_s);
  angle_deg_ += speed_deg_s() * step_s;
  const bool slow = std::abs(drive_deg_s_) <= 2 * limit * step_s;
  const bool there = mode_ != Mode::travelling || std::abs(target_deg_ - angle_deg_) < 1e-3;
  if (!slow || !there) return;
  drive_deg_s_ = 0;
  if (mode_ == Mode::travelling) {
    angle_deg_ = target_deg_;
  } else {
    target_deg_ = angle_deg_;
  }
  mode_ = Mode::standing;
}

void SimMotor::advance(double to_s) {
  asked_s_ = std::max(asked_s_, to_s);
  while (stepped_s_ + step_s <= to_s) {
    if (mode_ == Mode::standing) {
      stepped_s_ += std::floor((to_s - stepped_s_) / step_s) * step_s;
      return;
    }
    step();
    stepped_s_ += step_s;
  }
}

}  // namespace vam::sim
