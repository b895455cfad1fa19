// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/saddle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vam::optimize {

namespace {

template <class Value>
double total(std::span<const Slab> images, const Value& value) {
  double sum = 0;
  for (const auto& lane : summed(images, value)) {
    for (const float part : lane) sum += static_cast<double>(part);
  }
  return sum;
}

template <class Value>
void fill(std::span<Slab> images, const Value& value) {
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) images[s].values[i] = value(s, i);
  });
}

// Of the step: such a fall of the change moves the anchor, at once or where it rises again; and so many steps do.
constexpr double enough_fall = 0.2, some_fall = 0.8, long_share = 0.36;
constexpr int long_steps = 50;

constexpr double slack_share = 1;  // of the slack in the norm of a step, relative to the weights

/// The largest eigenvalue of the preconditioner.
double largest_gain(const light::Operator& light) {
  constexpr int rounds = 12;
  std::vector<Slab> v = slabs(1, light.sinogram().width, light.sinogram().height);
  fill(v,
       [](std::size_t, std::size_t i) { return (i / lanes) % 2 == 0 ? 1.0F : -0.9F; });  // near the Nyquist frequency
  double gain = 1;
  for (int round = 0; round < rounds; ++round) {
    const auto square = [&](std::size_t s, std::size_t i) { return v[s].values[i] * v[s].values[i]; };
    const double before = std::sqrt(total(v, square));
    light.precondition(v);
    gain = std::sqrt(total(v, square)) / before;
    const auto unit = static_cast<float>(1 / (gain * before));
    fill(v, [&](std::size_t s, std::size_t i) { return v[s].values[i] * unit; });
  }
  return gain;
}

}  // namespace

double Saddle::Change::norm() const { return std::sqrt(std::max(light + weights + slack + 2 * coupled, 0.0)); }

Saddle::Saddle(const light::Operator& light, std::vector<Slab> sign, std::vector<Slab> g, double eigenvalue)
    : light_(light), sign_(std::move(sign)), eigenvalue_(eigenvalue), largest_gain_(largest_gain(light)) {
  const std::size_t count = sign_.size();
  const auto volume = [&] { return slabs(count, light.object().width, light.object().height); };
  const auto rays = [&] { return slabs(count, light.sinogram().width, light.sinogram().height); };
  const double voxels = total(sign_, [&](std::size_t s, std::size_t i) { return std::abs(sign_[s].values[i]); });
  const double void_voxels =
      total(sign_, [&](std::size_t s, std::size_t i) { return std::max(-sign_[s].values[i], 0.0F); });
  constexpr double usual = 0.18;  // where the ratio that is reached and the bound come near at about equal speed
  weight_step_ = usual / std::sqrt(std::max(voxels, 1.0));
  now_ = {std::move(g), volume(), volume(), rays(), rays()};
  const auto even = static_cast<float>(void_voxels > 0 ? 1 / void_voxels : 0);
  fill(now_.weights, [&](std::size_t s, std::size_t i) { return std::min(sign_[s].values[i], 0.0F) * even; });
  light.forward(now_.weights, now_.balance);
  light.adjoint(now_.light, now_.dose);
  anchor_ = now_;
  next_ = now_;
}

double Saddle::slack_step() const { return slack_share * weight_step_ * eigenvalue_ / largest_gain_; }

void Saddle::step() {
  advance_light();
  advance_slack();
  advance_weights();
  const Change all = change();
  const double now = all.norm();
  if (since_ == 0) first_change_ = now;
  const bool fallen = now <= enough_fall * first_change_ || (now <= some_fall * first_change_ && now > last_change_);
  last_change_ = now;
  ++steps_;
  if (since_ > 2 && (fallen || since_ >= long_share * steps_ + long_steps)) return move_anchor(all);
  draw_to_anchor();
  ++since_;
}

/// g' = g + t P (A (y - z) + u)
void Saddle::advance_light() {
  const auto by = static_cast<float>(1 / (weight_step_ * eigenvalue_ * (1 + slack_share)));
  fill(next_.light, [&](std::size_t s, std::size_t i) { return now_.balance[s].values[i] + now_.slack[s].values[i]; });
  light_.precondition(next_.light);
  fill(next_.light,
       [&](std::size_t s, std::size_t i) { return now_.light[s].values[i] + by * next_.light[s].values[i]; });
  light_.adjoint(next_.light, next_.dose);
}

/// u' = max(0, u - r (2 g' - g))
void Saddle::advance_slack() {
  const auto by = static_cast<float>(slack_step());
  fill(next_.slack, [&](std::size_t s, std::size_t i) {
    const float ahead = 2 * next_.light[s].values[i] - now_.light[s].values[i];
    return std::max(0.0F, now_.slack[s].values[i] - by * ahead);
  });
}

/// With x = A* (2 g' - g): y' = max(0, y + s (1 - x)); z' = max(0, z + s (x - l)), l such that sum z' = 1.
void Saddle::advance_weights() {
  const auto by = static_cast<float>(weight_step_);
  fill(next_.weights, [&](std::size_t s, std::size_t i) {
    const float sign = sign_[s].values[i];
    if (sign == 0) return 0.0F;
    const float x = 2 * next_.dose[s].values[i] - now_.dose[s].values[i];
    const float free = now_.weights[s].values[i] - by * x;
    return sign > 0 ? std::max(0.0F, free + by) : free;
  });
  settle_level();
  const auto level = static_cast<float>(level_);
  fill(next_.weights, [&](std::size_t s, std::size_t i) {
    const float weight = next_.weights[s].values[i];
    return sign_[s].values[i] < 0 ? std::min(0.0F, weight + by * level) : weight;
  });
  light_.forward(next_.weights, next_.balance);
}

/// Newton's method; the sum of z is convex in the level.
void Saddle::settle_level() {
  constexpr int most_rounds = 20;
  constexpr double enough = 1e-6;
  const auto by = static_cast<float>(weight_step_);
  for (int round = 0; round < most_rounds; ++round) {
    const auto level = static_cast<float>(level_);
    const auto z = [&](std::size_t s, std::size_t i) {
      return sign_[s].values[i] < 0 ? std::max(0.0F, -next_.weights[s].values[i] - by * level) : 0.0F;
    };
    const double sum = total(sign_, z);
    const double lit = total(sign_, [&](std::size_t s, std::size_t i) { return z(s, i) > 0 ? 1.0F : 0.0F; });
    if (std::abs(sum - 1) < enough) return;
    level_ = lit > 0 ? level_ + (sum - 1) / (weight_step_ * lit) : 0.5 * level_;
  }
}

/// Of the last step, in its own metric: P^-1 of the light's step is what was preconditioned.
Saddle::Change Saddle::change() const {
  const auto step = [](std::span<const Slab> from, std::span<const Slab> to) {
    return [from, to](std::size_t s, std::size_t i) { return to[s].values[i] - from[s].values[i]; };
  };
  const auto light = step(now_.light, next_.light);
  const auto weights = step(now_.weights, next_.weights);
  const auto slack = step(now_.slack, next_.slack);
  const auto balance = step(now_.balance, next_.balance);
  Change sum;
  sum.light = total(now_.light, [&](std::size_t s, std::size_t i) {
    return light(s, i) * (now_.balance[s].values[i] + now_.slack[s].values[i]);
  });
  sum.weights =
      total(now_.weights, [&](std::size_t s, std::size_t i) { return weights(s, i) * weights(s, i); }) / weight_step_;
  sum.slack = total(now_.slack, [&](std::size_t s, std::size_t i) { return slack(s, i) * slack(s, i); }) / slack_step();
  sum.coupled =
      total(now_.light, [&](std::size_t s, std::size_t i) { return light(s, i) * (balance(s, i) + slack(s, i)); });
  return sum;
}

/// Halpern's iteration of the reflected step.
void Saddle::draw_to_anchor() {
  const float on = (static_cast<float>(since_) + 1) / (static_cast<float>(since_) + 2);
  for (const auto part :
       {&SaddlePoint::light, &SaddlePoint::dose, &SaddlePoint::weights, &SaddlePoint::balance, &SaddlePoint::slack}) {
    fill(now_.*part, [&](std::size_t s, std::size_t i) {
      const float reflected = 2 * (next_.*part)[s].values[i] - (now_.*part)[s].values[i];
      return on * reflected + (1 - on) * (anchor_.*part)[s].values[i];
    });
  }
}

/// To the last step; and steps of light and weights are made to go equally far.
void Saddle::move_anchor(const Change& change) {
  constexpr double most = 2;
  if (change.light > 0 && change.weights > 0) {
    weight_step_ *= std::clamp(std::pow(change.weights / change.light, 0.25), 1 / most, most);
  }
  now_ = next_;
  anchor_ = next_;
  since_ = 0;
}

}  // namespace vam::optimize
