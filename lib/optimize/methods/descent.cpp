// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/private/descent.hpp"

#include <algorithm>

#include "optimize/methods/private/safeguard.hpp"

namespace vam::optimize {

namespace {
constexpr float descent_shorter = 0.3F;

PerSlice squares(const std::vector<Slab>& a) {
  return summed(a, [&](std::size_t s, std::size_t i) { return a[s].values[i] * a[s].values[i]; });
}

/// above / below for each slice; `otherwise` where that is no length.
PerSlice ratio(const PerSlice& above, const PerSlice& below, const PerSlice& otherwise) {
  PerSlice result = otherwise;
  for_slices(above, [&](std::size_t s, std::size_t lane) {
    if (below[s][lane] > 0) result[s][lane] = above[s][lane] / below[s][lane];
  });
  return result;
}

}  // namespace

void Descent::start(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  Method::start(problem, light, iterate);
  start_at_threshold(problem, light, iterate);
  prepare(problem, light, iterate);
}

void Descent::resume(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  Method::resume(problem, light, iterate);
  prepare(problem, light, iterate);
}

void Descent::exchange(Archive& archive) {
  archive(length_);
  archive(loss_);
}

/// Cauchy's step <g, g> / <A* g, A* g>, g the gradient, would be the best one if the loss were |A* g|^2 / 2.
void Descent::prepare(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  enter_bounds(problem, light, largest_light(options_, light), iterate);
  loss_ = losses(problem, light, iterate.dose);
  differentiate(problem, light, iterate);
  light.adjoint(gradient_, before_.dose);
  length_ =
      ratio(pooled(squares(gradient_), light), pooled(squares(before_.dose), light), filled(gradient_.size(), 0.0F));
}

void Descent::differentiate(const Problem& problem, const light::Operator& light, const Iterate& iterate) {
  if (before_.g.empty()) {
    before_ = iterate;
    gradient_ = iterate.g;
  }
  for_values(iterate.dose, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      before_.dose[s].values[i] = slope(problem, s, i, iterate.dose[s].values[i]);
    }
  });
  light.forward(before_.dose, gradient_);
}

PerSlice Descent::losses(const Problem& problem, const light::Operator& light, const std::vector<Slab>& dose) const {
  return pooled(summed(dose, [&](std::size_t s, std::size_t i) { return loss(problem, s, i, dose[s].values[i]); }),
                light);
}

void Descent::step(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  differentiate(problem, light, iterate);
  const float peak = largest_light(options_, light);
  for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      float& now = iterate.g[s].values[i];
      before_.g[s].values[i] = now;
      now = std::clamp(now - length_[s][i % lanes] * gradient_[s].values[i], 0.0F, peak);
    }
  });
  std::swap(iterate.dose, before_.dose);
  light.adjoint(iterate.g, iterate.dose);
  judge(problem, light, iterate);
}

/// The next step's length, Barzilai and Borwein's <dg, dg> / <dx, dr>, or a shorter one for slices that went back.
void Descent::judge(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  const PerSlice moved = summed(iterate.g, [&](std::size_t s, std::size_t i) {
    const float dg = iterate.g[s].values[i] - before_.g[s].values[i];
    return dg * dg;
  });
  const PerSlice bent = summed(iterate.dose, [&](std::size_t s, std::size_t i) {
    const float now = iterate.dose[s].values[i];
    const float before = before_.dose[s].values[i];
    return (now - before) * (slope(problem, s, i, now) - slope(problem, s, i, before));
  });
  const PerSlice next = ratio(pooled(moved, light), pooled(bent, light), length_);
  const PerSlice back = go_back(iterate, before_, loss_, losses(problem, light, iterate.dose));
  for_slices(back, [&](std::size_t s, std::size_t lane) {
    length_[s][lane] = back[s][lane] != 0.0F ? length_[s][lane] * descent_shorter : next[s][lane];
  });
}

}  // namespace vam::optimize
