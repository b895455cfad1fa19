// SPDX-License-Identifier: GPL-3.0-or-later
// What every operator must pass.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "base/compute/per_slice.hpp"
#include "base/compute/slab.hpp"
#include "light/operators/operator.hpp"
#include "optimize/methods/method.hpp"
#include "oracle/part_2d.hpp"

namespace parts {

/// One slice in the first lane of a slab, the other lanes empty.
inline vam::Slab packed(const std::vector<float>& image, int size) {
  vam::Slab slab(size, size);
  pack(image.data(), 1, slab);
  return slab;
}

inline vam::Slab noise(vam::light::Shape shape, unsigned seed) {
  vam::Slab slab(shape.width, shape.height);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (float& v : slab.values) v = uniform(random);
  return slab;
}

inline double dot(const vam::Slab& a, const vam::Slab& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    sum += static_cast<double>(a.values[i]) * static_cast<double>(b.values[i]);
  return sum;
}

inline vam::Slab dose_of(const vam::light::Operator& light, const vam::Slab& g) {
  vam::Slab dose(light.object().width, light.object().height);
  light.adjoint({&g, 1}, {&dose, 1});
  return dose;
}

inline double adjoint_error(const vam::light::Operator& light) {
  const vam::Slab f = noise(light.object(), 1);
  const vam::Slab g = noise(light.sinogram(), 2);
  vam::Slab projected(light.sinogram().width, light.sinogram().height);
  light.forward({&f, 1}, {&projected, 1});
  return std::abs(dot(projected, g) - dot(f, dose_of(light, g))) / std::sqrt(dot(projected, projected) * dot(g, g));
}

/// Of a grid of `count` slabs, in which one of `every` values is not 0.
inline double adjoint_error_of_volume(const vam::light::Operator& light, std::size_t count, std::size_t every = 1) {
  std::vector<vam::Slab> f, g;
  for (unsigned s = 0; s < count; ++s) {
    f.push_back(noise(light.object(), 10 + s));
    for (std::size_t i = 0; i < f.back().values.size(); ++i) f.back().values[i] *= i % every == 0 ? 1 : 0;
    g.push_back(noise(light.sinogram(), 20 + s));
  }
  std::vector<vam::Slab> projected = vam::slabs(count, light.sinogram().width, light.sinogram().height);
  std::vector<vam::Slab> dose = vam::slabs(count, light.object().width, light.object().height);
  light.forward(f, projected);
  light.adjoint(g, dose);
  double left = 0, right = 0, size = 0, given = 0;
  for (std::size_t s = 0; s < count; ++s) {
    left += dot(projected[s], g[s]);
    right += dot(f[s], dose[s]);
    size += dot(projected[s], projected[s]);
    given += dot(g[s], g[s]);
  }
  return std::abs(left - right) / std::sqrt(size * given);
}

/// The preconditioner must be symmetric and positive definite.
inline void check_preconditioner(const vam::light::Operator& light) {
  const vam::Slab a = noise(light.sinogram(), 3);
  const vam::Slab b = noise(light.sinogram(), 4);
  vam::Slab pa = a;
  vam::Slab pb = b;
  light.precondition({&pa, 1});
  light.precondition({&pb, 1});
  CHECK(std::abs(dot(pa, b) - dot(a, pb)) / std::sqrt(dot(pa, pa) * dot(b, b)) < 1e-5);  // in float
  CHECK(dot(a, pa) > 0);
}

/// Unclipped filtered back-projection must give a disc of ones again: relative error in its middle, dose outside.
inline void check_disc_comes_back(const vam::light::Operator& light, double error, double outside) {
  const int size = light.object().width;
  const double place = 0.1 * size;
  const auto disc =
      vam::oracle::draw(size, [&](double x, double y) { return std::hypot(x - place, y + 0.5 * place) < 0.25 * size; });
  const vam::Slab f = packed(disc, size);
  std::vector<vam::Slab> g;
  vam::optimize::filtered_projections(light, {&f, 1}, g);
  const vam::Slab dose = dose_of(light, g[0]);
  const int middle = size / 2;
  const auto step = static_cast<int>(place);
  CHECK(*dose.at(middle + step, middle - step / 2) == doctest::Approx(1.0).epsilon(error));
  CHECK(std::abs(*dose.at(middle - 3 * step, middle + 3 * step)) < outside);
}

}  // namespace parts
