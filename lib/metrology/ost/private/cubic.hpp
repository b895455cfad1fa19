// Pixels between pixels: Keys' cubic convolution with a = -1/2 [KEYS81].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/image.hpp"

namespace vam::metrology {

/// Weights of the pixels -1, 0, 1, 2 about the fraction f.
inline std::array<float, 4> cubic_weights(float f) {
  const float g = 1 - f;
  return {-0.5F * f * g * g, 1 - 2.5F * f * f + 1.5F * f * f * f, 1 - 2.5F * g * g + 1.5F * g * g * g,
          -0.5F * g * f * f};
}

/// At row y of column x; beyond the image its last row.
inline float cubic_down(const Image& image, int x, double y) {
  const double whole = std::floor(y);
  const auto weights = cubic_weights(static_cast<float>(y - whole));
  float sum = 0;
  for (int j = 0; j < 4; ++j)
    sum += weights[static_cast<std::size_t>(j)] *
           image(x, std::clamp(static_cast<int>(whole) + j - 1, 0, image.height - 1));
  return sum;
}

/// At (x, y); beyond the image its last pixels.
inline float cubic_at(const Image& image, double x, double y) {
  const double whole = std::floor(x);
  const auto weights = cubic_weights(static_cast<float>(x - whole));
  float sum = 0;
  for (int i = 0; i < 4; ++i) {
    const int column = std::clamp(static_cast<int>(whole) + i - 1, 0, image.width - 1);
    sum += weights[static_cast<std::size_t>(i)] * cubic_down(image, column, y);
  }
  return sum;
}

}  // namespace vam::metrology
