#include "light/blurred_operator.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/per_slice.hpp"
#include "light/blur.hpp"

namespace vam::light {

namespace {

constexpr int tile = 4;  // pixels of a row that are blurred along y together

/// to = sum over taps of from, `stride` floats apart, `count` floats each; from[0] is the middle and both sides of it
/// hold `weights.size() - 1` strides more.
void add_taps(const float* from, std::ptrdiff_t stride, const std::vector<float>& weights, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] = weights[0] * from[i];
  for (std::size_t n = 1; n < weights.size(); ++n) {
    const float* up = from + static_cast<std::ptrdiff_t>(n) * stride;
    const float* down = from - static_cast<std::ptrdiff_t>(n) * stride;
    for (int i = 0; i < count; ++i) to[i] += weights[n] * (up[i] + down[i]);
  }
}

}  // namespace

int halo_slices(double sigma_px) { return std::min(lanes, static_cast<int>(std::ceil(3 * sigma_px))); }

BlurredOperator::BlurredOperator(const Operator& sharp, double sigma_px, int slices) : sharp_(sharp), slices_(slices) {
  for (const double weight : light::gaussian_weights(sigma_px)) weights_.push_back(static_cast<float>(weight));
}

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
  throw Error{Fault::bug, "blur: needs the whole grid, not a range of its slabs"};
}

void BlurredOperator::adjoint_within(const Window<const Slab>&, const Window<Slab>&) const {
  throw Error{Fault::bug, "blur: needs the whole grid, not a range of its slabs"};
}

void BlurredOperator::blur(std::span<Slab> objects) const {
  const int width = objects[0].width;
  const int height = objects[0].height;
  const int count = static_cast<int>(objects.size());
  parallel_for(count * height, [&](int i) { blur_row(objects[i / height].at(0, i % height), width); });
  const int tiles = (width + tile - 1) / tile;
  parallel_for(count * tiles, [&](int i) {
    const int first = i % tiles * tile;
    blur_columns(objects[i / tiles], first, std::min(tile, width - first));
  });
  parallel_for(height, [&](int y) { blur_stack(objects, y); });
}

void BlurredOperator::blur_row(float* row, int width) const {
  const std::size_t reach = (weights_.size() - 1) * lanes;
  const std::size_t count = static_cast<std::size_t>(width) * lanes;
  thread_local std::vector<float> padded;
  padded.assign(count + 2 * reach, 0.0F);
  std::copy_n(row, count, padded.data() + reach);
  add_taps(padded.data() + reach, lanes, weights_, row, static_cast<int>(count));
}

void BlurredOperator::blur_columns(Slab& slab, int first, int count) const {
  const std::size_t reach = weights_.size() - 1;
  const std::size_t row = static_cast<std::size_t>(count) * lanes;
  thread_local std::vector<float> padded;
  padded.assign((static_cast<std::size_t>(slab.height) + 2 * reach) * row, 0.0F);
  for (int y = 0; y < slab.height; ++y) {
    std::copy_n(slab.at(first, y), row, padded.data() + (static_cast<std::size_t>(y) + reach) * row);
  }
  for (int y = 0; y < slab.height; ++y) {
    add_taps(padded.data() + (static_cast<std::size_t>(y) + reach) * row, static_cast<std::ptrdiff_t>(row), weights_,
             slab.at(first, y), static_cast<int>(row));
  }
}

/// Along z: the slices in use, one above the other.
void BlurredOperator::blur_stack(std::span<Slab> objects, int y) const {
  const std::size_t reach = weights_.size() - 1;
  const int used = std::min(slices_, static_cast<int>(objects.size()) * lanes);
  std::vector<float> padded(static_cast<std::size_t>(used) + 2 * reach, 0.0F);
  std::vector<float> result(objects.size() * lanes, 0.0F);
  for (int x = 0; x < objects[0].width; ++x) {
    for (int k = 0; k < used; ++k) {
      padded[reach + static_cast<std::size_t>(k)] = objects[k / lanes].at(x, y)[k % lanes];
    }
    add_taps(padded.data() + reach, 1, weights_, result.data(), used);
    for (std::size_t s = 0; s < objects.size(); ++s) std::copy_n(result.data() + s * lanes, lanes, objects[s].at(x, y));
  }
}

}  // namespace vam::light
