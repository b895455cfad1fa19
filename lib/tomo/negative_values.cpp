// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/negative_values.hpp"

#include <algorithm>

#include "base/compute/parallel.hpp"

namespace vam::tomo {

float lowest(const Slab& slab) {
  std::vector<float> rows(slab.height, 0.0F);
  parallel_for(slab.height, [&](int y) {
    const float* values = slab.at(0, y);
    rows[y] = *std::min_element(values, values + std::ptrdiff_t{slab.width} * lanes);
  });
  return std::min(0.0F, *std::min_element(rows.begin(), rows.end()));
}

void raise_and_clip(Slab& slab, float raise, float floor) {
  parallel_for(slab.height, [&](int y) {
    float* values = slab.at(0, y);
    for (int i = 0; i < slab.width * lanes; ++i) values[i] = std::max(values[i] + raise, floor);
  });
}

const std::vector<std::string>& negative_names() {
  static const std::vector<std::string> names{"keep", "clip", "offset"};
  return names;
}

}  // namespace vam::tomo
