// SPDX-License-Identifier: GPL-3.0-or-later
// Applies a resampling plan: 16 slices side by side, one tile of output columns at a time, so that a tile's input stays
// in cache.
#include "optics/resample.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "base/compute/parallel.hpp"
#include "base/compute/simd.hpp"
#include "base/compute/slab.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "optics/private/resample_kernel.hpp"

namespace vam::optics {

namespace {

static_assert(lanes == resample_lanes);
constexpr int tile_columns = 16;  // one cache line of an output row

using Index = std::ptrdiff_t;

struct ResampleKernels {
  decltype(&baseline::mix_columns) mix;
  decltype(&baseline::shift_rows) shift;
};

ResampleKernels kernels() { return {VAM_KERNEL(mix_columns, simd_level()), VAM_KERNEL(shift_rows, simd_level())}; }

// Columns [first, last) of up to 16 images as [column][row][16]; missing lanes are 0.
void pack(std::span<const Image> images, int first, int last, std::vector<float>& packed) {
  const int rows = images.front().height;
  packed.resize(Index{last - first} * rows * lanes);
  for (int r = 0; r < rows; ++r) {
    std::array<const float*, lanes> from{};
    for (std::size_t s = 0; s < images.size(); ++s) from[s] = images[s].row(r) + first;
    side_by_side(std::span(from).first(images.size()), last - first, packed.data() + Index{r} * lanes,
                 Index{rows} * lanes);
  }
}

void unpack(const std::vector<float>& packed, int first, int last, std::span<Image> images) {
  const int rows = images.front().height;
  for (int r = 0; r < rows; ++r) {
    std::array<float*, lanes> to{};
    for (std::size_t s = 0; s < images.size(); ++s) to[s] = images[s].row(r) + first;
    one_by_one(packed.data() + Index{r} * lanes, Index{rows} * lanes, last - first, std::span(to).first(images.size()));
  }
}

void resample_tile(const ResamplePlan& plan, const ResampleKernels& kernel, int first, int last,
                   std::span<const Image> in, std::span<Image> out) {
  int low = plan.columns_in;
  int high = 0;
  for (int c = first; c < last; ++c) {
    const ColumnSource& source = plan.sources[c];
    if (source.count == 0) continue;
    low = std::min(low, source.first);
    high = std::max(high, source.first + source.count);
  }
  if (low >= high) return;  // all dark; the images are zero already

  thread_local std::vector<float> packed;
  thread_local std::vector<float> column;
  thread_local std::vector<float> result;
  pack(in, low, high, packed);
  const Index stride = Index{plan.rows} * lanes;
  column.resize(stride + Index{3} * lanes);
  result.assign(stride * (last - first), 0.0F);
  for (int c = first; c < last; ++c) {
    const ColumnSource& source = plan.sources[c];
    if (source.count == 0) continue;
    kernel.mix(packed.data() + (source.first - low) * stride, stride, plan.weights.data() + source.weights,
               source.count, plan.rows, column.data());
    std::copy_n(column.data(), 3 * lanes, column.data() + stride);  // the turn closes
    kernel.shift(column.data(), plan.rows, source.row, plan.sense, source.angle_weights,
                 result.data() + (c - first) * stride);
  }
  if (!plan.keep_negative) {
    for (float& value : result) value = std::max(value, 0.0F);
  }
  unpack(result, first, last, out);
}

}  // namespace

void resample(const ResamplePlan& plan, std::span<const Image> in, std::span<Image> out) {
  for (const Image& image : in) {
    if (image.width != plan.columns_in || image.height != plan.rows) {
      throw Error{Fault::data, "sinogram: a slice has " + std::to_string(image.width) + " x " +
                                   std::to_string(image.height) + " pixels, the first has " +
                                   std::to_string(plan.columns_in) + " x " + std::to_string(plan.rows)};
    }
  }
  for (Image& image : out) image = Image(plan.columns_out, plan.rows);
  const ResampleKernels kernel = kernels();
  const int slices = count_of(in);
  const int groups = (slices + lanes - 1) / lanes;
  const int tiles = (plan.columns_out + tile_columns - 1) / tile_columns;
  parallel_for(groups * tiles, [&](int item) {
    const int first = item % tiles * tile_columns;
    const int last = std::min(first + tile_columns, plan.columns_out);
    const auto slice = static_cast<std::size_t>(item / tiles) * lanes;
    const auto count = std::min<std::size_t>(lanes, in.size() - slice);
    resample_tile(plan, kernel, first, last, in.subspan(slice, count), out.subspan(slice, count));
  });
}

}  // namespace vam::optics
