// What a real bench adds to the views of a print: an even background, light that flickers, specks that stay where they
// are, bubbles that pass. Specks and bubbles are distinguished from the print by consistency over the angles: a line is
// seen twice a turn, from either end.
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "base/json_fwd.hpp"

namespace vam::metrology {

/// What was found in the views of one turn and taken out.
struct Dirt {
  double background = 0;        // even, in view units
  bool has_background = false;  // false: no part of the image is empty, nothing was subtracted
  double flicker_percent = 0;   // RMS of the views' intensities; removed where it exceeds 0.5
  double speck_percent = 0;     // of the rays that the volume needs, seen through specks and taken from the other end
  double bubble_percent = 0;    // of them, brighter than the same line from the other end and taken from there
  bool bubbles_exceed_limit = false;  // so many rays differ that it is no dirt, and none was replaced for it
};

/// The level of the emptiest tenth of a mean view, when hardly a pixel is darker: the shortest interval that holds a
/// tenth of the pixels, refined to a mean. Dirt::has_background is false where there is no such plateau.
[[nodiscard]] Dirt even_background(const Image& mean_view);

/// Sinograms of one stretch of heights, columns x an even number of angles over a turn, axis in the middle. A pixel of
/// their mean over the angles that departs from its row and has no mirror image about the axis is a speck; with two
/// pixels around it, it is replaced by the line seen from the other end. Returns the share of the rays.
double remove_specks(std::vector<Image>& sinograms);

/// Replaces rays that are brighter than the same line from the other end, anywhere within two columns and `rows[k]`
/// heights of it, by more than 6 deviations of the noise and 3 % of the brightest: something passed. Where this is more
/// than 10 % of the rays nothing is replaced. Returns the share.
double remove_bubbles(std::vector<Image>& sinograms, std::span<const int> rows);
inline constexpr double most_bubbles = 0.1;

[[nodiscard]] Json to_json(const Dirt& dirt);

}  // namespace vam::metrology
