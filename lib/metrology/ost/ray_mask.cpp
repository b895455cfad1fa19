// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/ray_mask.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace vam::metrology {

double share_of(const RayMask& marked) {
  const auto count = std::count(marked.begin(), marked.end(), char{1});
  return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, marked.size()));
}

RayMask grown(const RayMask& marked, int width, int height, int by) {
  RayMask out(marked.size(), 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (marked[product(y, width) + x] == 0) continue;
      for (int j = std::max(0, y - by); j <= std::min(height - 1, y + by); ++j) {
        char* row = out.data() + std::ptrdiff_t{j} * width;
        std::fill(row + std::max(0, x - by), row + std::min(width, x + by + 1), char{1});
      }
    }
  }
  return out;
}

}  // namespace vam::metrology
