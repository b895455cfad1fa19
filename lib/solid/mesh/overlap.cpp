// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/overlap.hpp"

#include <algorithm>

namespace vam::solid {

Bounds overlap(std::vector<Bounds> boxes) {
  // Sweep along x: only boxes that begin before another ends can share something with it.
  std::sort(boxes.begin(), boxes.end(), [](const Bounds& a, const Bounds& b) { return a.low < b.low; });
  Bounds all;
  for (auto a = boxes.begin(); a != boxes.end(); ++a) {
    if (all.contains(*a)) continue;
    for (auto b = a + 1; b != boxes.end() && b->low[0] < a->high[0]; ++b) {
      Bounds both;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        both.low[axis] = std::max(a->low[axis], b->low[axis]);
        both.high[axis] = std::min(a->high[axis], b->high[axis]);
      }
      const Point size = both.size();
      if (size[0] > 0 && size[1] > 0 && size[2] > 0) all.join(both);
    }
  }
  return all;
}

}  // namespace vam::solid
