// SPDX-License-Identifier: GPL-3.0-or-later
// Sums with the Gaussian of beam and resin along x, y and z of a volume [physics §4].
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/index.hpp"

namespace vam::light {

/// Weights {middle, first neighbours, ...} of the discrete Gaussian e^{-t} I_n(t), t = sigma^2 in pixels: the heat
/// kernel of the lattice [LIN90]. Its variance is sigma^2 exactly, however narrow it is, and
/// two in a row are one with the sum of the variances. From t = 500 on it is the sampled Gaussian, which is the same to
/// 1e-4 of its height. Cut where less than 1e-9 is left, then normalised.
[[nodiscard]] std::vector<double> gaussian_weights(double sigma_px);

class GaussianBlur {
 public:
  /// sigma in voxels.
  explicit GaussianBlur(double sigma_px);

  /// Neighbours on either side that count.
  [[nodiscard]] int half_width() const { return count_of(weights_) - 1; }
  /// Of the n-th neighbour, 0 the middle.
  [[nodiscard]] float weight(int n) const { return weights_[n]; }

  /// `count` sums over values `stride` floats apart, about from[0] and those that follow it; half_width() strides are
  /// known on both sides.
  void sum(const float* from, std::ptrdiff_t stride, float* to, int count) const;
  /// Planes of height rows of width elements of `depth` floats each, in place along x and y; dark outside.
  void across(std::span<float* const> planes, int width, int height, int depth) const;

 private:
  void row(float* values, int width, int depth) const;
  void columns(float* plane, std::ptrdiff_t pitch, int height, int count) const;

  std::vector<float> weights_;  // middle, first neighbours, ...
};

}  // namespace vam::light
