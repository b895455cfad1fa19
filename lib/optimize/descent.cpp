#include "optimize/descent.hpp"

#include <algorithm>

namespace vam::optimize {

namespace {
constexpr float shorter = 0.3F;

/// Inner products of differences, slice by slice: <a - b, c - d>.
PerSlice dot(const std::vector<Slab>& a, const std::vector<Slab>& b, const std::vector<Slab>& c,
             const std::vector<Slab>& d) {
  return summed(a, [&](std::size_t s, std::size_t i) {
    return (a[s].values[i] - b[s].values[i]) * (c[s].values[i] - d[s].values[i]);
  });
}

PerSlice squares(const std::vector<Slab>& a) {
  return summed(a, [&](std::size_t s, std::size_t i) { return a[s].values[i] * a[s].values[i]; });
}

}  // namespace

void Descent::start(const Problem& problem, const Operator& light, Iterate& iterate) {
  Method::start(problem, light, iterate);
  const PerSlice factor = to_common_threshold(metrics(iterate.dose, problem), problem);
  scale(iterate.g, factor);
  scale(iterate.dose, factor);
  prepare(problem, light, iterate);
}

void Descent::resume(const Problem& problem, const Operator& light, Iterate& iterate) {
  Method::resume(problem, light, iterate);
  prepare(problem, light, iterate);
}

void Descent::prepare(const Problem& problem, const Operator& light, const Iterate& iterate) {
  before_ = iterate;
  gradient_ = iterate.g;
  slope_ = slope_before_ = iterate.dose;
  peak_ = options_.peak > 0 ? static_cast<float>(options_.peak * light.row_angle_rad()) : 3e38F;
  loss_ = losses(problem, iterate.dose);
  slopes(problem, iterate.dose, slope_);
  light.forward(slope_, gradient_);
  light.adjoint(gradient_, slope_before_);
  const PerSlice g = squares(gradient_);
  const PerSlice x = squares(slope_before_);
  length_ = g;
  for (std::size_t s = 0; s < g.size(); ++s) {
    for (std::size_t lane = 0; lane < lanes; ++lane) length_[s][lane] = x[s][lane] > 0 ? g[s][lane] / x[s][lane] : 0.0F;
  }
}

void Descent::slopes(const Problem& problem, const std::vector<Slab>& dose, std::vector<Slab>& to) const {
  for_values(to, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      to[s].values[i] = slope(dose[s].values[i], problem.target[s].values[i], problem.labels[s][i]);
    }
  });
}

PerSlice Descent::losses(const Problem& problem, const std::vector<Slab>& dose) const {
  return summed(dose, [&](std::size_t s, std::size_t i) {
    return loss(dose[s].values[i], problem.target[s].values[i], problem.labels[s][i]);
  });
}

void Descent::step(const Problem& problem, const Operator& light, Iterate& iterate) {
  slopes(problem, iterate.dose, slope_);
  light.forward(slope_, gradient_);
  std::swap(slope_, slope_before_);
  for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      float& now = iterate.g[s].values[i];
      before_.g[s].values[i] = now;
      now = std::clamp(now - length_[s][i % lanes] * gradient_[s].values[i], 0.0F, peak_);
    }
  });
  std::swap(iterate.dose, before_.dose);
  light.adjoint(iterate.g, iterate.dose);
  judge(problem, iterate);
}

void Descent::judge(const Problem& problem, Iterate& iterate) {
  const PerSlice now = losses(problem, iterate.dose);
  slopes(problem, iterate.dose, slope_);
  const PerSlice moved = dot(iterate.g, before_.g, iterate.g, before_.g);
  const PerSlice bent = dot(iterate.dose, before_.dose, slope_, slope_before_);
  PerSlice back(now.size());
  for (std::size_t s = 0; s < now.size(); ++s) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      back[s][lane] = now[s][lane] > loss_[s][lane] ? 1.0F : 0.0F;
      if (back[s][lane] != 0.0F) {
        length_[s][lane] *= shorter;
        continue;
      }
      loss_[s][lane] = now[s][lane];
      if (bent[s][lane] > 0) length_[s][lane] = moved[s][lane] / bent[s][lane];
    }
  }
  restore(iterate.g, before_.g, back);
  restore(iterate.dose, before_.dose, back);
}

}  // namespace vam::optimize
