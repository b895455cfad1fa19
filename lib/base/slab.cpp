// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/slab.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam {

namespace {

constexpr int block = 4096;  // pixels a work item: 256 KiB of slab

template <class Work>
void over_blocks(const Slab& slab, const Work& work) {
  const std::size_t pixels = slab.values.size() / lanes;
  const int count = static_cast<int>((pixels + block - 1) / block);
  parallel_for(count, [&](int item) {
    const std::size_t first = product(item, block);
    work(first, std::min(first + block, pixels));
  });
}

}  // namespace

void pack(const float* images, int count, Slab& slab) {
  const std::size_t pixels = slab.values.size() / lanes;
  over_blocks(slab, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      float* to = slab.values.data() + p * lanes;
      for (int s = 0; s < count; ++s) to[s] = images[product(s, pixels) + p];
      for (int s = count; s < lanes; ++s) to[s] = 0;
    }
  });
}

void unpack(const Slab& slab, int count, float* images) {
  const std::size_t pixels = slab.values.size() / lanes;
  over_blocks(slab, [&](std::size_t first, std::size_t last) {
    for (int s = 0; s < count; ++s) {
      float* to = images + product(s, pixels);
      for (std::size_t p = first; p < last; ++p) to[p] = slab.values[p * lanes + s];
    }
  });
}

}  // namespace vam
