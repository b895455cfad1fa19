// SPDX-License-Identifier: GPL-3.0-or-later
// What the optimisers' tests share: parts side by side in one pass, figures out.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "light/operators/make_operator.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/run_method.hpp"

namespace parts {

inline vam::tomo::ParallelGeometry turn(int size, int angles) {
  const double centre = 0.5 * (size - 1);
  return {size, size, size, angles, centre, centre, 0, 2 * std::numbers::pi / angles, 0};
}

inline vam::optimize::Circle circle(int size) { return {0.5 * (size - 1), 0.5 * (size - 1), 0.5 * (size - 1)}; }

/// Through clear resin.
inline std::unique_ptr<vam::light::Operator> parallel_light(int size, int angles) {
  return vam::light::make_operator(vam::light::ParallelBeam{turn(size, angles)});
}

/// The same around inserts.
inline std::unique_ptr<vam::light::Operator> parallel_light(int size, int angles, std::span<const vam::Slab> inserts) {
  return vam::light::make_operator(vam::light::ParallelBeam{turn(size, angles), 0, 0.5 * size}, inserts);
}

/// `count` row-major slices of width x height, one after the other, and weights and tolerances for them if there are
/// any. Throws Fault::usage for contradictory thresholds.
inline vam::optimize::Problem make_problem(const float* slices, int count, int width, int height,
                                           const vam::optimize::Circle& circle, const vam::optimize::Demands& demands,
                                           const float* weight = nullptr, const float* tolerance = nullptr,
                                           bool stacked = false) {
  check(demands);
  vam::optimize::Problem problem{.slices = 0,
                                 .stacked = stacked,
                                 .target = {},
                                 .labels = {},
                                 .demands = demands,
                                 .weight = {},
                                 .tolerance = {},
                                 .delivered = {}};
  const auto pixels = static_cast<std::size_t>(width) * height;
  const auto from = [&](const float* images, int first) {
    return images == nullptr ? nullptr : images + static_cast<std::size_t>(first) * pixels;
  };
  for (int first = 0; first < count; first += vam::lanes) {
    append(problem, {from(slices, first), from(weight, first), from(tolerance, first)},
           std::min(vam::lanes, count - first), width, height, circle);
  }
  if (stacked) resolve_thin_slices(problem);
  return problem;
}

inline std::vector<float> stacked(const std::vector<std::vector<float>>& slices) {
  std::vector<float> all;
  for (const auto& slice : slices) all.insert(all.end(), slice.begin(), slice.end());
  return all;
}

/// The dose of each ray alone, of a single slice: [ray][voxel].
inline std::vector<std::vector<double>> ray_doses(const vam::light::Operator& light) {
  const auto rays = light.sinogram();
  const auto voxels = light.object();
  std::vector<std::vector<double>> doses;
  for (int ray = 0; ray < rays.width * rays.height; ++ray) {
    vam::Slab g(rays.width, rays.height), dose(voxels.width, voxels.height);
    g.values[static_cast<std::size_t>(ray) * vam::lanes] = 1;
    light.adjoint({&g, 1}, {&dose, 1});
    std::vector<double>& row = doses.emplace_back();
    for (std::size_t i = 0; i < dose.values.size(); i += vam::lanes) row.push_back(dose.values[i]);
  }
  return doses;
}

/// Figures of each slice after so many iterations; nothing stops them early.
inline std::vector<vam::model::DoseMetrics> run(const std::vector<std::vector<float>>& slices, int size, int angles,
                                                const std::string& name, const vam::optimize::MethodOptions& options,
                                                int iterations, const vam::optimize::Demands& demands = {}) {
  const auto light = parallel_light(size, angles);
  const auto all = stacked(slices);
  const auto problem = make_problem(all.data(), static_cast<int>(slices.size()), size, size, circle(size), demands);
  const auto method = vam::optimize::make_method(name, options);
  vam::optimize::Iterate state;
  vam::optimize::run_method(*method, problem, *light, {.iterations = iterations, .until = {}, .patience = 0}, state);
  return vam::optimize::metrics(state.dose, problem);
}

}  // namespace parts
