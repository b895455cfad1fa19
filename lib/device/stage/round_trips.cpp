// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/round_trips.hpp"

#include <algorithm>
#include <cmath>

namespace vam::device {

namespace {
constexpr double encoder_sigma_deg = 1e-4;
constexpr double unequal = 1.0 / 3;    // of the shortest round trip
constexpr double slowest_deg_s = 0.5;  // below, offsets are noise
constexpr double ripple_s = 3e-3;      // what else moves the angle off a line, in time
}  // namespace

AngleSample RoundTrips::timed(const StageSample& sample, double speed_deg_s) {
  const double taken_s = sample.t1_s - sample.t0_s;
  shortest_s_ = std::min(shortest_s_, taken_s);
  beyond_s_ = taken_s - shortest_s_;
  last_ = sample;
  speed_deg_s_ = speed_deg_s;
  return at_share(share_, ++seen_ <= enough);
}

AngleSample RoundTrips::at_share(double share, bool whole) const {
  // Even over both ways where the share is 0. A share of 0.5 leaves nothing unknown of most round trips, but of some.
  constexpr double least_unknown = 0.5;
  const double unknown_s = std::max(least_unknown, std::sqrt(1 - 4 * share * share)) * beyond_s_;
  const double spread_s = whole ? last_.t1_s - last_.t0_s : std::hypot(unknown_s, unequal * shortest_s_);
  const double blur_deg = std::abs(speed_deg_s_) * spread_s / std::sqrt(12.0);
  const double rounding_deg = std::max(last_.step_deg / std::sqrt(12.0), encoder_sigma_deg);
  const double t_s = 0.5 * (last_.t0_s + last_.t1_s) + share * beyond_s_;
  return {t_s, last_.angle_deg, std::hypot(blur_deg, rounding_deg)};
}

// The slope of the offsets in time, by least squares about their means, with the prior that every share is as likely.
void RoundTrips::learn(double off_deg, double speed_deg_s) {
  if (seen_ <= enough || std::abs(speed_deg_s) < slowest_deg_s) return;
  const double off_s = off_deg / speed_deg_s;
  ++count_;
  sum_ += beyond_s_;
  sum_off_ += off_s;
  squares_ += beyond_s_ * beyond_s_;
  products_ += beyond_s_ * off_s;
  const double prior = 12 * ripple_s * ripple_s;
  const double slope = (products_ - sum_ * sum_off_ / count_) / (squares_ - sum_ * sum_ / count_ + prior);
  constexpr double most = 0.49;  // something is always unknown
  share_ = std::clamp(slope, -most, most);
}

}  // namespace vam::device
