#include "device/stage/private/ripple_filter.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace vam::device {

namespace {

constexpr double unknown_speed_deg_s = 100;
constexpr double likely_ripple_deg = 0.25;  // sigma of the k-th harmonic is that over k: 0.4 % of the speed each
constexpr double wander_per_s = 1e-3;       // of the speed
constexpr double least_wander_deg_s = 1e-3;
constexpr double jump_sigmas = 6;  // an innovation beyond is no noise
constexpr double least_span_s = 0.25;

}  // namespace

void RippleFilter::begin(const AngleSample& sample) {
  state_ = {};
  spread_ = {};
  state_[0] = sample.angle_deg;
  spread_[0][0] = sample.sigma_deg * sample.sigma_deg;
  spread_[1][1] = unknown_speed_deg_s * unknown_speed_deg_s;
  for (std::size_t k = 1; k <= harmonics; ++k) {
    const double sigma_deg = likely_ripple_deg / static_cast<double>(k);
    for (const std::size_t place : {2 * k, 2 * k + 1}) spread_[place][place] = sigma_deg * sigma_deg;
  }
  first_s_ = t_s_ = sample.t_s;
}

RippleFilter::Vector RippleFilter::seen_at(double angle_deg) {
  Vector seen{};
  seen[0] = 1;
  const double step = angle_deg * rad_per_deg;
  for (std::size_t k = 1; k <= harmonics; ++k) {
    seen[2 * k] = std::cos(static_cast<double>(k) * step);
    seen[2 * k + 1] = std::sin(static_cast<double>(k) * step);
  }
  return seen;
}

RippleFilter::Vector RippleFilter::times(const Vector& vector) const {
  Vector product{};
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) product[i] += spread_[i][j] * vector[j];
  }
  return product;
}

void RippleFilter::advance(double to_s) {
  const double dt = to_s - t_s_;
  t_s_ = to_s;
  state_[0] += dt * state_[1];
  for (std::size_t j = 0; j < size; ++j) spread_[0][j] += dt * spread_[1][j];
  for (std::size_t i = 0; i < size; ++i) spread_[i][0] += dt * spread_[i][1];
  const double wander = std::max(least_wander_deg_s, wander_per_s * std::abs(state_[1]));
  spread_[1][1] += wander * wander * std::abs(dt);
}

void RippleFilter::add(const AngleSample& sample) {
  if (count_++ == 0) return begin(sample);
  advance(sample.t_s);
  const Vector seen = seen_at(sample.angle_deg);
  const double noise = std::max(sample.sigma_deg * sample.sigma_deg, 1e-8);
  const auto expected = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < size; ++i) sum += seen[i] * state_[i];
    return sum;
  };
  const double off_deg = sample.angle_deg - expected();
  Vector gain = times(seen);
  const auto variance = [&] {
    double sum = noise;
    for (std::size_t i = 0; i < size; ++i) sum += seen[i] * gain[i];
    return sum;
  };
  if (off_deg * off_deg > jump_sigmas * jump_sigmas * variance()) {  // it started, stopped or slipped
    spread_[0][0] += off_deg * off_deg;
    spread_[1][1] += unknown_speed_deg_s * unknown_speed_deg_s;
    gain = times(seen);
  }
  const double total = variance();
  const Vector common = gain;
  for (double& value : gain) value /= total;
  for (std::size_t i = 0; i < size; ++i) state_[i] += gain[i] * off_deg;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) spread_[i][j] -= gain[i] * common[j];
  }
}

bool RippleFilter::ready() const { return count_ >= 3 && t_s_ - first_s_ >= least_span_s; }

double RippleFilter::ripple_deg(double angle_deg) const {
  const Vector seen = seen_at(angle_deg);
  double sum = 0;
  for (std::size_t i = 2; i < size; ++i) sum += seen[i] * state_[i];
  return sum;
}

AngleSample RippleFilter::at(double t_s) const {
  const double dt = t_s - t_s_;
  const double line_deg = state_[0] + dt * state_[1];
  double angle_deg = line_deg;
  for (int pass = 0; pass < 3; ++pass)
    angle_deg = line_deg + ripple_deg(angle_deg);  // the ripple is of the angle itself
  Vector seen = seen_at(angle_deg);
  seen[1] = dt;
  const Vector common = times(seen);
  double variance = 0;
  for (std::size_t i = 0; i < size; ++i) variance += seen[i] * common[i];
  return {t_s, angle_deg, std::sqrt(std::max(0.0, variance))};
}

}  // namespace vam::device
