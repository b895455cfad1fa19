// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/blur/blur_stream.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>

#include "base/compute/parallel.hpp"
#include "light/blur/gaussian_blur.hpp"

namespace vam::light {

BlurStream::BlurStream(double sigma_px, std::function<void(Image)> out)
    : smear_(std::make_unique<GaussianBlur>(sigma_px)), out_(std::move(out)) {}
BlurStream::~BlurStream() = default;

void BlurStream::push(Image slice) {
  float* const plane = slice.values.data();
  smear_->across(std::span(&plane, 1), slice.width, slice.height, 1);
  held_.push_back(std::move(slice));
  ++pushed_;
  if (pushed_ - emitted_ > smear_->half_width()) emit(emitted_);
}

void BlurStream::finish() {
  while (emitted_ < pushed_) emit(emitted_);
}

void BlurStream::emit(int centre) {
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
