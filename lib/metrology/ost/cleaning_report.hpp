// SPDX-License-Identifier: GPL-3.0-or-later
// Disturbances of a real bench in the views of a print: an even background, flicker, static specks, passing bubbles.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "base/text/json_fwd.hpp"

namespace vam::metrology {

/// Disturbances that were removed from the views of one turn.
struct CleaningReport {
  double background = 0;        // even, in view units
  bool has_background = false;  // false: no part of the image is empty, nothing was subtracted
  double flicker_percent = 0;   // RMS of the views' intensities; removed where it exceeds 0.5
  double speck_percent = 0;     // of the rays that the volume needs, seen through specks and taken from the other end
  double bubble_percent = 0;    // of them, brighter than the same line from the other end and taken from there
  bool bubbles_exceed_limit = false;  // so many rays differ that it is no dirt, and none was replaced for it
};

/// The light of each view over that of the median view: less or more than that of the others [physics §8]. Empty where
/// it is not determined, or does not change.
struct Flicker {
  double percent = 0;             // RMS from 1, without what growth explains
  std::vector<double> intensity;  // of each view
};
inline constexpr double removed_flicker_percent = 0.5;  // at least; below, the views are left as they are

/// The level of the emptiest tenth of a mean view, when hardly a pixel is darker: the shortest interval that holds a
/// tenth of the pixels, refined to a mean. CleaningReport::has_background is false where there is no such plateau.
[[nodiscard]] CleaningReport even_background(const Image& mean_view);

[[nodiscard]] Json to_json(const CleaningReport& dirt);

}  // namespace vam::metrology
