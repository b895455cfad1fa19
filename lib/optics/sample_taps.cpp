// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/private/sample_taps.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace vam::optics {

namespace {

// Positions come from sums and quotients of decimal numbers; within this of the grid they are meant to be on it.
constexpr double rounding = 1e-9;

Taps interpolation(double position) {
  const double nearest = std::round(position);
  if (std::abs(position - nearest) < rounding) return {static_cast<int>(nearest), {1.0F}};
  const double below = std::floor(position);
  const auto part = static_cast<float>(position - below);
  return {static_cast<int>(below), {1 - part, part}};
}

}  // namespace

Taps mean_taps(double position, double width) {
  const double low = position - 0.5 * width;
  const double high = position + 0.5 * width;
  Taps taps{floor_int(low + 0.5 + rounding), {}};
  for (int k = taps.first; k - 0.5 < high - rounding; ++k) {
    const double overlap = std::min(k + 0.5, high) - std::max(k - 0.5, low);
    taps.weights.push_back(static_cast<float>(overlap / width));
  }
  return taps;
}

Taps sample_taps(double position, double width) {
  return width > 1 + rounding ? mean_taps(position, width) : interpolation(position);
}

}  // namespace vam::optics
