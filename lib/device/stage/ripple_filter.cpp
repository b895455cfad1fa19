// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/private/ripple_filter.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace vam::device {

namespace {

constexpr double unknown_speed_deg_s = 100;
constexpr double likely_ripple_deg = 0.25;  // sigma of the k-th harmonic is that over k: 0.4 % of the speed each
constexpr double unseen_ripple_deg = 1e-3;  // sigma of one that does not stand out
constexpr double wander_per_s = 1e-3;       // of the speed
constexpr double least_wander_deg_s = 1e-3;
constexpr double jump_sigmas = 6;  // an innovation beyond is no noise
constexpr double least_span_s = 0.25;
constexpr double least_variance = 1e-8;  // of a sample, in degrees squared

// A harmonic's power in units of its variance: noise alone exceeds 4 in exp(-4), 2 %, of all harmonics.
constexpr double power_of_noise = 4;
constexpr double power_beyond_doubt = 20;

}  // namespace

RippleFilter::Vector RippleFilter::StateEstimate::covariance_with(const Vector& seen) const {
  Vector product{};
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) product[i] += covariance[i][j] * seen[j];
  }
  return product;
}

double RippleFilter::StateEstimate::expected(const Vector& seen) const {
  double sum = 0;
  for (std::size_t i = 0; i < size; ++i) sum += seen[i] * mean[i];
  return sum;
}

double RippleFilter::StateEstimate::variance(const Vector& seen) const {
  const Vector common = covariance_with(seen);
  double sum = 0;
  for (std::size_t i = 0; i < size; ++i) sum += seen[i] * common[i];
  return sum;
}

void RippleFilter::StateEstimate::observe(const Vector& seen, double value, double noise) {
  const Vector common = covariance_with(seen);
  double total = noise;
  for (std::size_t i = 0; i < size; ++i) total += seen[i] * common[i];
  correct(common, total, value - expected(seen));
}

void RippleFilter::StateEstimate::observe_zero(std::size_t place, double noise) {
  const Vector common = covariance[place];
  correct(common, common[place] + noise, -mean[place]);
}

void RippleFilter::StateEstimate::correct(const Vector& common, double total, double off) {
  for (std::size_t i = 0; i < size; ++i) {
    const double gain = common[i] / total;
    mean[i] += gain * off;
    for (std::size_t j = 0; j < size; ++j) covariance[i][j] -= gain * common[j];
  }
}

void RippleFilter::begin(const AngleSample& sample) {
  all_ = {};
  all_.mean[0] = sample.angle_deg;
  all_.covariance[0][0] = sample.sigma_deg * sample.sigma_deg;
  all_.covariance[1][1] = unknown_speed_deg_s * unknown_speed_deg_s;
  for (std::size_t k = 1; k <= harmonics; ++k) {
    const double sigma_deg = likely_ripple_deg / static_cast<double>(k);
    for (const std::size_t place : {2 * k, 2 * k + 1}) all_.covariance[place][place] = sigma_deg * sigma_deg;
  }
  first_s_ = t_s_ = sample.t_s;
  first_deg_ = sample.angle_deg;
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

void RippleFilter::advance(double to_s) {
  const double dt = to_s - t_s_;
  t_s_ = to_s;
  auto& covariance = all_.covariance;
  all_.mean[0] += dt * all_.mean[1];
  for (std::size_t j = 0; j < size; ++j) covariance[0][j] += dt * covariance[1][j];
  for (std::size_t i = 0; i < size; ++i) covariance[i][0] += dt * covariance[i][1];
  const double wander = std::max(least_wander_deg_s, wander_per_s * std::abs(all_.mean[1]));
  covariance[1][1] += wander * wander * std::abs(dt);
}

void RippleFilter::add(const AngleSample& sample) {
  without_noise_.reset();
  if (count_++ == 0) return begin(sample);
  advance(sample.t_s);
  const Vector seen = seen_at(sample.angle_deg);
  const double noise = std::max(sample.sigma_deg * sample.sigma_deg, least_variance);
  const double off_deg = sample.angle_deg - all_.expected(seen);
  const double sigma_deg = std::sqrt(std::max(0.0, all_.variance(seen)) + noise);
  if (std::abs(off_deg) > jump_sigmas * sigma_deg) {  // it started, stopped or slipped
    all_.covariance[0][0] += off_deg * off_deg;
    all_.covariance[1][1] += unknown_speed_deg_s * unknown_speed_deg_s;
  }
  all_.observe(seen, sample.angle_deg, noise);
  farthest_deg_ = std::max(farthest_deg_, std::abs(sample.angle_deg - first_deg_));
}

bool RippleFilter::ready() const { return count_ >= 3 && t_s_ - first_s_ >= least_span_s; }

// That a harmonic is as small as its power beyond the noise is an observation of its own: harmonics do not change, so
// it may as well be made last.
const RippleFilter::StateEstimate& RippleFilter::without_noise() const {
  if (without_noise_) return *without_noise_;
  StateEstimate& kept = without_noise_.emplace(all_);
  if (farthest_deg_ < 360) return kept;  // before, line and harmonics are not distinguished
  for (std::size_t k = 1; k <= harmonics; ++k) {
    double power = 0;
    double noise = 0;
    for (const std::size_t place : {2 * k, 2 * k + 1}) {
      power += 0.5 * all_.mean[place] * all_.mean[place];
      noise += 0.5 * all_.covariance[place][place];
    }
    if (power > power_beyond_doubt * noise) continue;
    const double likely = std::max(unseen_ripple_deg * unseen_ripple_deg, power - power_of_noise * noise);
    for (const std::size_t place : {2 * k, 2 * k + 1}) kept.observe_zero(place, likely);
  }
  return kept;
}

AngleSample RippleFilter::at(double t_s) const {
  const StateEstimate& estimate = without_noise();
  const double dt = t_s - t_s_;
  double angle_deg = estimate.mean[0] + dt * estimate.mean[1];
  Vector seen{};
  for (int pass = 0; pass < 3; ++pass) {  // the ripple is of the angle itself
    seen = seen_at(angle_deg);
    seen[1] = dt;
    angle_deg = estimate.expected(seen);
  }
  return {t_s, angle_deg, std::sqrt(std::max(0.0, estimate.variance(seen)))};
}

double RippleFilter::speed_deg_s() const { return without_noise().mean[1]; }

void learn(RoundTrips& trips, RippleFilter& middles) {
  const AngleSample now = trips.middle();
  if (middles.ready()) trips.learn(now.angle_deg - middles.at(now.t_s).angle_deg, middles.speed_deg_s());
  middles.add(now);
}

}  // namespace vam::device
