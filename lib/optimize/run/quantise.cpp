// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/quantise.hpp"

#include <algorithm>

#include "resin/dither.hpp"

namespace vam::optimize {

double largest(std::span<const Image> images) {
  float most = 0;
  for (const Image& image : images) {
    for (const float value : image.values) most = std::max(most, value);
  }
  return static_cast<double>(most);
}

void quantise(std::span<Image> images, const resin::GreyLevels& levels, double full_scale, bool error_feedback) {
  if (!(full_scale > 0)) return;
  const auto full = static_cast<float>(full_scale);
  const resin::Dither dither(levels, 1);
  for (Image& image : images) {
    for (float& value : image.values) value /= full;
    if (error_feedback) image = resin::dithered(image, dither);
    for (float& value : image.values) value = full * (error_feedback ? value : levels.intensity(levels.level(value)));
  }
}

}  // namespace vam::optimize
