// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/simulation/display_range.hpp"

#include <algorithm>

namespace vam::light {

void shine(const DisplayRange& light, std::span<Image> sinograms, LightSeen& seen) {
  const float scale = light.full_scale ? static_cast<float>(1 / *light.full_scale) : 1.0F;
  const float least = light.full_scale ? static_cast<float>(light.dark) : 0.0F;
  for (Image& image : sinograms) {
    for (float& value : image.values) {
      seen.peak = std::max(seen.peak, static_cast<double>(value));
      seen.least = std::min(seen.least, static_cast<double>(value));
      seen.negative += value < 0 ? 1 : 0;
      value *= scale;
      if (light.clip) value = std::max(value, least);
      if (light.full_scale) value = std::min(value, 1.0F);
    }
    seen.values += static_cast<double>(image.size());
    seen.efficiency.add(image.values);
  }
}

}  // namespace vam::light
