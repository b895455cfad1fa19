// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/ray_mask.hpp"

#include <algorithm>

#include "base/compute/parallel.hpp"
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

RayMask other_ends(RayMask marked, int width) {
  for (auto row = marked.begin(); row != marked.end(); row += width) std::reverse(row, row + width);
  return marked;
}

void mark_too(const RayMask& more, RayMask& marked) {
  if (marked.empty()) marked.resize(more.size(), 0);
  for (std::size_t i = 0; i < more.size(); ++i) marked[i] = static_cast<char>(marked[i] | more[i]);
}

void keep_marked(const RayMask& other, RayMask& marked) {
  if (other.empty()) marked.clear();
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = static_cast<char>(marked[i] & other[i]);
}

void choose_ends(std::vector<Image>& sinograms, const std::vector<RayMask>& marked, float (*choose)(float, float)) {
  parallel_for(count_of(sinograms), [&](int k) {
    Image& s = sinograms[k];
    const Image before = s;
    for (int a = 0; a < s.height; ++a) {
      if (marked[a].empty()) continue;
      const char* row = marked[a].data() + product(k, s.width);
      for (int t = 0; t < s.width; ++t) {
        if (row[t] != 0) s(t, a) = choose(before(t, a), before(s.width - 1 - t, opposite(s, a)));
      }
    }
  });
}

}  // namespace vam::metrology
