// SPDX-License-Identifier: GPL-3.0-or-later
// An image between its pixels, by cubic convolution [KEYS81].
#pragma once

#include <algorithm>
#include <cmath>

#include "base/cubic.hpp"
#include "base/image.hpp"

namespace vam::metrology {

/// At row y of column x; beyond the image its last row.
inline float cubic_down(const Image& image, int x, double y) {
  const double whole = std::floor(y);
  const auto weights = cubic_weights(static_cast<float>(y - whole));
  float sum = 0;
  for (int j = 0; j < 4; ++j)
    sum += weights[j] * image(x, std::clamp(static_cast<int>(whole) + j - 1, 0, image.height - 1));
  return sum;
}

/// At (x, y); beyond the image its last pixels.
inline float cubic_at(const Image& image, double x, double y) {
  const double whole = std::floor(x);
  const auto weights = cubic_weights(static_cast<float>(x - whole));
  float sum = 0;
  for (int i = 0; i < 4; ++i) {
    const int column = std::clamp(static_cast<int>(whole) + i - 1, 0, image.width - 1);
    sum += weights[i] * cubic_down(image, column, y);
  }
  return sum;
}

}  // namespace vam::metrology
