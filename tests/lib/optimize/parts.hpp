// What the optimisers' tests share: parts side by side in one pass, figures out; what every operator must pass.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "optimize/iterate.hpp"
#include "optimize/metrics.hpp"
#include "optimize/parallel_operator.hpp"

namespace parts {

inline vam::tomo::ParallelGeometry turn(int size, int angles) {
  const double centre = 0.5 * (size - 1);
  return {size, size, size, angles, centre, centre, 0, 2 * std::numbers::pi / angles, 0};
}

inline vam::optimize::Circle circle(int size) { return {0.5 * (size - 1), 0.5 * (size - 1), 0.5 * (size - 1)}; }

inline std::vector<float> stacked(const std::vector<std::vector<float>>& slices) {
  std::vector<float> all;
  for (const auto& slice : slices) all.insert(all.end(), slice.begin(), slice.end());
  return all;
}

/// Figures of each slice after so many iterations; nothing stops them early.
inline std::vector<vam::model::DoseMetrics> run(const std::vector<std::vector<float>>& slices, int size, int angles,
                                                const std::string& name, const vam::optimize::MethodOptions& options,
                                                int iterations, const vam::optimize::Demands& demands = {}) {
  const vam::optimize::ParallelOperator light(turn(size, angles));
  const auto all = stacked(slices);
  const auto problem =
      vam::optimize::make_problem(all.data(), static_cast<int>(slices.size()), size, size, circle(size), demands);
  const auto method = vam::optimize::make_method(name, options);
  vam::optimize::Iterate state;
  vam::optimize::iterate(*method, problem, light, {.iterations = iterations, .until = {}, .patience = 0}, state);
  return vam::optimize::metrics(state.dose, problem);
}

inline vam::tomo::Slab noise(vam::optimize::Shape shape, unsigned seed) {
  vam::tomo::Slab slab(shape.width, shape.height);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (float& v : slab.values) v = uniform(random);
  return slab;
}

inline double dot(const vam::tomo::Slab& a, const vam::tomo::Slab& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    sum += static_cast<double>(a.values[i]) * static_cast<double>(b.values[i]);
  return sum;
}

inline vam::tomo::Slab dose_of(const vam::optimize::Operator& light, const vam::tomo::Slab& g) {
  vam::tomo::Slab dose(light.object().width, light.object().height);
  light.adjoint({&g, 1}, {&dose, 1});
  return dose;
}

inline double adjoint_error(const vam::optimize::Operator& light) {
  const vam::tomo::Slab f = noise(light.object(), 1);
  const vam::tomo::Slab g = noise(light.sinogram(), 2);
  vam::tomo::Slab projected(light.sinogram().width, light.sinogram().height);
  light.forward({&f, 1}, {&projected, 1});
  return std::abs(dot(projected, g) - dot(f, dose_of(light, g))) / std::sqrt(dot(projected, projected) * dot(g, g));
}

inline double asymmetry_of_preconditioner(const vam::optimize::Operator& light) {
  const vam::tomo::Slab a = noise(light.sinogram(), 3);
  const vam::tomo::Slab b = noise(light.sinogram(), 4);
  vam::tomo::Slab pa = a;
  vam::tomo::Slab pb = b;
  light.precondition({&pa, 1});
  light.precondition({&pb, 1});
  return std::abs(dot(pa, b) - dot(a, pb)) / std::sqrt(dot(pa, pa) * dot(b, b));
}

}  // namespace parts
