#include "light/blur.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <span>
#include <utility>

#include "base/parallel.hpp"
#include "light/private/gaussian_blur.hpp"

namespace vam::light {

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

double spread_mm(double psf_mm, double diffusion_mm2_s, double seconds) {
  return std::sqrt(psf_mm * psf_mm + 2 * diffusion_mm2_s * seconds);
}

VolumeBlur::VolumeBlur(double sigma_px, std::function<void(Image)> out)
    : smear_(std::make_unique<GaussianBlur>(sigma_px)), out_(std::move(out)) {}
VolumeBlur::~VolumeBlur() = default;

void VolumeBlur::push(Image slice) {
  float* const plane = slice.values.data();
  smear_->across(std::span(&plane, 1), slice.width, slice.height, 1);
  held_.push_back(std::move(slice));
  ++pushed_;
  if (pushed_ - emitted_ > smear_->half_width()) emit(emitted_);
}

void VolumeBlur::finish() {
  while (emitted_ < pushed_) emit(emitted_);
}

void VolumeBlur::emit(int centre) {
  Image result(held_.front().width, held_.front().height);
  const int low = std::max(centre - smear_->half_width(), 0);
  const int high = std::min(centre + smear_->half_width(), pushed_ - 1);
  parallel_for(result.height, [&](int y) {
    float* to = result.row(y);
    for (int k = low; k <= high; ++k) {
      const float weight = smear_->weight(std::abs(k - centre));
      const float* from = held_[k - first_].row(y);
      for (int x = 0; x < result.width; ++x) to[x] += weight * from[x];
    }
  });
  ++emitted_;
  while (first_ < emitted_ - smear_->half_width()) {
    held_.pop_front();
    ++first_;
  }
  out_(std::move(result));
}

}  // namespace vam::light
