// SPDX-License-Identifier: GPL-3.0-or-later
// Noise that a camera cuts off at level 0 lifts the mean of dark pixels, but not that of lit ones [physics §10].
#pragma once

#include <vector>

#include "base/image.hpp"

namespace vam::metrology {

/// Sums over the pixels of a frame at one height; those of several frames add up.
struct BandReading {
  double pixels = 0;
  double light = 0;
  double zeros = 0;                       // pixels at level 0
  double dark_light = 0, dark_zeros = 0;  // light and zeros of the columns that are dark, if many are
  void add(const BandReading& other);
  [[nodiscard]] double mean() const { return light / pixels; }
};

/// Each of `bands` equally high bands of rows, top to bottom; a remainder at the bottom is left out. Throws Fault::data
/// when the image has fewer rows.
[[nodiscard]] std::vector<BandReading> band_readings(const Image& frame, int bands);

/// The means of the readings at one height, less what the noise that is cut off adds: that is nearly proportional to
/// the share of pixels at level 0, by a factor that the dark columns tell. The means themselves where no column is
/// dark.
[[nodiscard]] std::vector<double> without_cut_off(const std::vector<BandReading>& readings);

}  // namespace vam::metrology
