// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/blurred_operator.hpp"

#include <algorithm>

#include "base/compute/per_slice.hpp"
#include "base/index.hpp"
#include "light/blur/gaussian_blur.hpp"

namespace vam::light {

int halo_slices(double sigma_px) { return ceil_int(3 * sigma_px); }

BlurredOperator::BlurredOperator(const Operator& sharp, double sigma_px, int slices)
    : sharp_(sharp), slices_(slices), smear_(std::make_unique<GaussianBlur>(sigma_px)) {}
BlurredOperator::~BlurredOperator() = default;

void BlurredOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  std::vector<Slab> blurred(objects.begin(), objects.end());
  blur(blurred);
  sharp_.forward(blurred, sinograms);
}

void BlurredOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  sharp_.adjoint(sinograms, objects);
  blur(objects);
}

SlabRange BlurredOperator::lit_by(const SlabRange&) const {
  return sharp_.lit_by({0, static_cast<std::size_t>((slices_ + lanes - 1) / lanes)});
}

void BlurredOperator::blur(std::span<Slab> objects) const {
  std::vector<float*> planes;
  for (Slab& slab : objects) planes.push_back(slab.values.data());
  smear_->across(planes, objects[0].width, objects[0].height, lanes);
  parallel_for(objects[0].height, [&](int y) { blur_stack(objects, y); });
}

/// Along z: the slices in use, one above the other.
void BlurredOperator::blur_stack(std::span<Slab> objects, int y) const {
  const auto reach = static_cast<std::size_t>(smear_->half_width());
  const int used = std::min(slices_, count_of(objects) * lanes);
  std::vector<float> padded(static_cast<std::size_t>(used) + 2 * reach, 0.0F);
  std::vector<float> result(objects.size() * lanes, 0.0F);
  for (int x = 0; x < objects[0].width; ++x) {
    for (int k = 0; k < used; ++k) {
      padded[reach + k] = objects[k / lanes].at(x, y)[k % lanes];
    }
    smear_->sum(padded.data() + reach, 1, result.data(), used);
    for (std::size_t s = 0; s < objects.size(); ++s) std::copy_n(result.data() + s * lanes, lanes, objects[s].at(x, y));
  }
}

}  // namespace vam::light
