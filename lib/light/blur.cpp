#include "light/blur.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/parallel.hpp"

namespace vam::light {

namespace {

// Rows of a tile that share the passes along x and y.
constexpr int tile_rows = 32;

// to += weight * from, whole row.
void add_row(float* to, const float* from, float weight, int count) {
  for (int i = 0; i < count; ++i) to[i] += weight * from[i];
}

// Row blurred along x; outside it is dark.
void blur_row(const float* from, const std::vector<float>& weights, int width, std::vector<float>& padded, float* to) {
  const int reach = static_cast<int>(weights.size()) - 1;
  padded.assign(static_cast<std::size_t>(width) + 2 * (weights.size() - 1), 0.0F);
  std::copy_n(from, width, padded.data() + reach);
  std::fill_n(to, width, 0.0F);
  for (int n = -reach; n <= reach; ++n) {
    add_row(to, padded.data() + reach + n, weights[std::abs(n)], width);
  }
}

Image blur_across(const Image& slice, const std::vector<float>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  Image along(slice.width, slice.height);
  Image result(slice.width, slice.height);
  const int tiles = (slice.height + tile_rows - 1) / tile_rows;
  const auto each_row = [&](auto&& work) {
    parallel_for(tiles, [&](int tile) {
      for (int y = tile * tile_rows; y < std::min((tile + 1) * tile_rows, slice.height); ++y) work(y);
    });
  };
  each_row([&](int y) {
    thread_local std::vector<float> padded;
    blur_row(slice.row(y), weights, slice.width, padded, along.row(y));
  });
  each_row([&](int y) {
    for (int n = std::max(-reach, -y); n <= std::min(reach, slice.height - 1 - y); ++n) {
      add_row(result.row(y), along.row(y + n), weights[std::abs(n)], slice.width);
    }
  });
  return result;
}

}  // namespace

std::vector<double> gaussian_weights(double sigma_px) {
  const double t = sigma_px * sigma_px;
  // Beyond this the Bessel functions overflow, and the sampled Gaussian is the same to 1e-4 of its height.
  const bool wide = t > 500;
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

double spread_mm(double psf_mm, double diffusion_mm2_s, double seconds) {
  return std::sqrt(psf_mm * psf_mm + 2 * diffusion_mm2_s * seconds);
}

VolumeBlur::VolumeBlur(double sigma_px, std::function<void(Image)> out) : out_(std::move(out)) {
  for (const double weight : gaussian_weights(sigma_px)) weights_.push_back(static_cast<float>(weight));
}

void VolumeBlur::push(const Image& slice) {
  const int reach = static_cast<int>(weights_.size()) - 1;
  held_.push_back(blur_across(slice, weights_));
  ++pushed_;
  if (pushed_ - emitted_ > reach) emit(emitted_);
}

void VolumeBlur::finish() {
  while (emitted_ < pushed_) emit(emitted_);
}

void VolumeBlur::emit(int centre) {
  const int reach = static_cast<int>(weights_.size()) - 1;
  Image result(held_.front().width, held_.front().height);
  const int low = std::max(centre - reach, 0);
  const int high = std::min(centre + reach, pushed_ - 1);
  parallel_for(result.height, [&](int y) {
    for (int k = low; k <= high; ++k) {
      const Image& slice = held_[k - first_];
      add_row(result.row(y), slice.row(y), weights_[std::abs(k - centre)], result.width);
    }
  });
  ++emitted_;
  while (first_ < emitted_ - reach) {
    held_.pop_front();
    ++first_;
  }
  out_(std::move(result));
}

}  // namespace vam::light
