// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/saddle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "base/compute/per_slice.hpp"

namespace vam::optimize {

namespace {

// The anchor moves when the change of a step falls to enough_fall, to some_fall and rises again, or after long_steps.
constexpr double enough_fall = 0.2, some_fall = 0.8, long_share = 0.36;
constexpr int long_steps = 50;

constexpr double slack_share = 1;  // of the slack in the norm of a step, relative to the weights

constexpr std::array parts{&SaddlePoint::light, &SaddlePoint::dose, &SaddlePoint::weights, &SaddlePoint::balance,
                           &SaddlePoint::slack};

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

void SaddleState::exchange(Archive& archive) {
  for (SaddlePoint* point : {&now, &anchor}) {
    for (const auto part : parts) archive(point->*part);
  }
  for (double* number : {&weight_step, &level, &first_change, &last_change}) archive(*number);
  archive(steps);
  archive(since);
}

double Saddle::Change::norm() const { return std::sqrt(std::max(light + weights + slack + 2 * coupled, 0.0)); }

Saddle::Saddle(const light::Operator& light, std::vector<Slab> sign, double eigenvalue)
    : light_(light), sign_(std::move(sign)), eigenvalue_(eigenvalue), largest_gain_(largest_gain(light)) {
  const std::size_t count = sign_.size();
  const auto volume = [&] { return slabs(count, light.object().width, light.object().height); };
  const auto rays = [&] { return slabs(count, light.sinogram().width, light.sinogram().height); };
  next_ = {rays(), volume(), volume(), rays(), rays()};
}

SaddleState Saddle::begin(std::vector<Slab> g) const {
  const double voxels = total(sign_, [&](std::size_t s, std::size_t i) { return std::abs(sign_[s].values[i]); });
  constexpr double usual = 0.18;  // where the ratio that is reached and the bound come near at about equal speed
  SaddleState state;
  state.weight_step = usual / std::sqrt(std::max(voxels, 1.0));
  state.now = next_;
  state.now.light = std::move(g);
  const auto even = static_cast<float>(1 / std::max(voxels, 1.0));
  fill(state.now.weights, [&](std::size_t s, std::size_t i) { return sign_[s].values[i] * even; });
  fill(state.now.slack, [](std::size_t, std::size_t) { return 0.0F; });
  light_.forward(state.now.weights, state.now.balance);
  light_.adjoint(state.now.light, state.now.dose);
  state.anchor = state.now;
  return state;
}

double Saddle::slack_step(const SaddleState& state) const {
  return slack_share * state.weight_step * eigenvalue_ / largest_gain_;
}

void Saddle::step(SaddleState& state, const Aim& aim) {
  advance_light(state);
  advance_slack(state, aim.peak);
  advance_weights(state, aim.threshold);
  const Change all = change(state);
  const double now = all.norm();
  if (state.since == 0) state.first_change = now;
  const bool fallen =
      now <= enough_fall * state.first_change || (now <= some_fall * state.first_change && now > state.last_change);
  state.last_change = now;
  ++state.steps;
  if (state.since > 2 && (fallen || state.since >= long_share * state.steps + long_steps)) {
    return move_anchor(state, all);
  }
  draw_to_anchor(state);
  ++state.since;
}

/// g' = g + t P (A (y - z) + u)
void Saddle::advance_light(const SaddleState& state) {
  const SaddlePoint& now = state.now;
  const auto by = static_cast<float>(1 / (state.weight_step * eigenvalue_ * (1 + slack_share)));
  fill(next_.light, [&](std::size_t s, std::size_t i) { return now.balance[s].values[i] + now.slack[s].values[i]; });
  light_.precondition(next_.light);
  fill(next_.light,
       [&](std::size_t s, std::size_t i) { return now.light[s].values[i] + by * next_.light[s].values[i]; });
  light_.adjoint(next_.light, next_.dose);
}

/// With v = 2 g' - g - u / r: u' = r (min(max(v, 0), peak) - v)
void Saddle::advance_slack(const SaddleState& state, float peak) {
  const SaddlePoint& now = state.now;
  const auto by = static_cast<float>(slack_step(state));
  fill(next_.slack, [&](std::size_t s, std::size_t i) {
    const float ahead = 2 * next_.light[s].values[i] - now.light[s].values[i];
    const float free = now.slack[s].values[i] - by * ahead;
    if (free > 0) return free;
    return std::min(0.0F, free + by * peak);
  });
}

/// With x = A* (2 g' - g): y' = max(0, y + s (t - x - l)); z' = max(0, z + s (x - t - l)), l such that sum y' + sum z'
/// is 1.
void Saddle::advance_weights(SaddleState& state, double threshold) {
  const SaddlePoint& now = state.now;
  const auto by = static_cast<float>(state.weight_step);
  const auto t = static_cast<float>(threshold);
  fill(next_.weights, [&](std::size_t s, std::size_t i) {
    if (sign_[s].values[i] == 0) return 0.0F;
    const float x = 2 * next_.dose[s].values[i] - now.dose[s].values[i];
    return now.weights[s].values[i] + by * (t - x);
  });
  settle_level(state);
  const auto level = static_cast<float>(state.weight_step * state.level);
  fill(next_.weights, [&](std::size_t s, std::size_t i) {
    const float sign = sign_[s].values[i];
    return sign * std::max(0.0F, sign * next_.weights[s].values[i] - level);
  });
  light_.forward(next_.weights, next_.balance);
}

/// Newton's method; the sum is convex in the level.
void Saddle::settle_level(SaddleState& state) {
  constexpr int most_rounds = 30;
  constexpr double enough = 1e-6;
  const auto weight = [&](std::size_t s, std::size_t i) { return sign_[s].values[i] * next_.weights[s].values[i]; };
  for (int round = 0; round < most_rounds; ++round) {
    const auto level = static_cast<float>(state.weight_step * state.level);
    const auto left = [&](std::size_t s, std::size_t i) {
      return sign_[s].values[i] != 0 ? std::max(0.0F, weight(s, i) - level) : 0.0F;
    };
    const double sum = total(sign_, left);
    if (std::abs(sum - 1) < enough) return;
    const double lit = total(sign_, [&](std::size_t s, std::size_t i) { return left(s, i) > 0 ? 1.0F : 0.0F; });
    if (lit > 0) {
      state.level += (sum - 1) / (state.weight_step * lit);
      continue;
    }
    const PerSlice most = largest_of_all(reduce(
        sign_, std::numeric_limits<float>::lowest(),
        [&](float& a, std::size_t s, std::size_t i) { a = sign_[s].values[i] != 0 ? std::max(a, weight(s, i)) : a; },
        larger));
    if (most[0][0] == std::numeric_limits<float>::lowest()) return;  // no voxel is constrained
    state.level = (static_cast<double>(most[0][0]) - 1) / state.weight_step;
  }
}

double Saddle::largest_margin(const Aim& aim) const {
  const double difference =
      -total(next_.weights, [&](std::size_t s, std::size_t i) { return next_.weights[s].values[i]; });
  const double sum =
      total(next_.weights, [&](std::size_t s, std::size_t i) { return std::abs(next_.weights[s].values[i]); });
  const double above =
      total(next_.balance, [&](std::size_t s, std::size_t i) { return std::max(0.0F, next_.balance[s].values[i]); });
  return sum > 0 ? (aim.threshold * difference + static_cast<double>(aim.peak) * above) / sum
                 : std::numeric_limits<double>::max();
}

/// Change by the last step, in its own metric: P^-1 of the light's step is the gradient before preconditioning.
Saddle::Change Saddle::change(const SaddleState& state) const {
  const SaddlePoint& now = state.now;
  const auto step = [](std::span<const Slab> from, std::span<const Slab> to) {
    return [from, to](std::size_t s, std::size_t i) { return to[s].values[i] - from[s].values[i]; };
  };
  const auto light = step(now.light, next_.light);
  const auto weights = step(now.weights, next_.weights);
  const auto slack = step(now.slack, next_.slack);
  const auto balance = step(now.balance, next_.balance);
  Change sum;
  sum.light = total(now.light, [&](std::size_t s, std::size_t i) {
    return light(s, i) * (now.balance[s].values[i] + now.slack[s].values[i]);
  });
  sum.weights = total(now.weights, [&](std::size_t s, std::size_t i) { return weights(s, i) * weights(s, i); }) /
                state.weight_step;
  sum.slack =
      total(now.slack, [&](std::size_t s, std::size_t i) { return slack(s, i) * slack(s, i); }) / slack_step(state);
  sum.coupled =
      total(now.light, [&](std::size_t s, std::size_t i) { return light(s, i) * (balance(s, i) + slack(s, i)); });
  return sum;
}

/// Halpern's iteration of the reflected step.
void Saddle::draw_to_anchor(SaddleState& state) const {
  const float on = (static_cast<float>(state.since) + 1) / (static_cast<float>(state.since) + 2);
  for (const auto part : parts) {
    fill(state.now.*part, [&](std::size_t s, std::size_t i) {
      const float reflected = 2 * (next_.*part)[s].values[i] - (state.now.*part)[s].values[i];
      return on * reflected + (1 - on) * (state.anchor.*part)[s].values[i];
    });
  }
}

/// Moves the anchor to the last step, and balances the step lengths of light and weights.
void Saddle::move_anchor(SaddleState& state, const Change& change) const {
  constexpr double most = 2;
  if (change.light > 0 && change.weights > 0) {
    state.weight_step *= std::clamp(std::pow(change.weights / change.light, 0.25), 1 / most, most);
  }
  state.now = next_;
  state.anchor = next_;
  state.since = 0;
}

}  // namespace vam::optimize
