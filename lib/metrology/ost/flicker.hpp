// SPDX-License-Identifier: GPL-3.0-or-later
// Flicker: the light of one view is more or less than that of the others [physics §8].
#pragma once

#include <vector>

namespace vam::metrology {

/// The light of each view over that of the median view. Empty where it is not determined, or does not change.
struct Flicker {
  double percent = 0;             // RMS from 1, without what growth explains
  std::vector<double> intensity;  // of each view
};
inline constexpr double removed_flicker_percent = 0.5;  // at least; below, the views are left as they are

}  // namespace vam::metrology
