// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/blur/gaussian_blur.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"

namespace vam::light {

namespace {
constexpr int tile = 64;  // floats of a row that are blurred along y together
}  // namespace

std::vector<double> gaussian_weights(double sigma_px) {
  const double t = sigma_px * sigma_px;
  const bool wide = t > 500;  // the Bessel functions overflow
  std::vector<double> weights;
  double sum = 0;
  for (int n = 0; weights.empty() || 1 - sum > 1e-9; ++n) {
    const double weight = wide ? std::exp(-0.5 * n * n / t) / std::sqrt(2 * std::numbers::pi * t)
                               : std::exp(-t) * std::cyl_bessel_i(static_cast<double>(n), t);
    weights.push_back(weight);
    sum += n == 0 ? weight : 2 * weight;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

GaussianBlur::GaussianBlur(double sigma_px) {
  for (const double weight : gaussian_weights(sigma_px)) weights_.push_back(static_cast<float>(weight));
}

void GaussianBlur::sum(const float* from, std::ptrdiff_t stride, float* to, int count) const {
  for (int i = 0; i < count; ++i) to[i] = weights_[0] * from[i];
  for (std::size_t n = 1; n < weights_.size(); ++n) {
    const float* up = from + static_cast<std::ptrdiff_t>(n) * stride;
    const float* down = from - static_cast<std::ptrdiff_t>(n) * stride;
    for (int i = 0; i < count; ++i) to[i] += weights_[n] * (up[i] + down[i]);
  }
}

void GaussianBlur::across(std::span<float* const> planes, int width, int height, int depth) const {
  const auto pitch = std::ptrdiff_t{width} * depth;
  const int count = count_of(planes);
  parallel_for(count * height, [&](int i) { row(planes[i / height] + i % height * pitch, width, depth); });
  const int tiles = static_cast<int>((pitch + tile - 1) / tile);
  parallel_for(count * tiles, [&](int i) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(i % tiles) * tile;
    columns(planes[i / tiles] + first, pitch, height, static_cast<int>(std::min<std::ptrdiff_t>(tile, pitch - first)));
  });
}

void GaussianBlur::row(float* values, int width, int depth) const {
  const std::size_t dark = (weights_.size() - 1) * static_cast<std::size_t>(depth);
  const std::size_t count = product(width, depth);
  thread_local std::vector<float> padded;
  padded.assign(count + 2 * dark, 0.0F);
  std::copy_n(values, count, padded.data() + dark);
  sum(padded.data() + dark, depth, values, static_cast<int>(count));
}

void GaussianBlur::columns(float* plane, std::ptrdiff_t pitch, int height, int count) const {
  const std::size_t dark = weights_.size() - 1;
  const auto wide = static_cast<std::size_t>(count);
  thread_local std::vector<float> padded;
  padded.assign((static_cast<std::size_t>(height) + 2 * dark) * wide, 0.0F);
  for (int y = 0; y < height; ++y) {
    std::copy_n(plane + y * pitch, wide, padded.data() + (static_cast<std::size_t>(y) + dark) * wide);
  }
  for (int y = 0; y < height; ++y) {
    sum(padded.data() + (static_cast<std::size_t>(y) + dark) * wide, count, plane + y * pitch, count);
  }
}

}  // namespace vam::light
