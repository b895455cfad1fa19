// Bubbles pass through the views. They are distinguished from the print by consistency over the angles: a line is seen
// twice a turn, from either end, and a bubble is seldom there both times.
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "tomo/radon.hpp"

namespace vam::metrology {

/// Sinograms of one stretch of heights, columns x an even number of angles over a turn, axis in the middle. A ray that
/// is brighter than the same line from the other end, anywhere within two columns and `rows[k]` heights of it, by more
/// than 6 deviations of the noise and 3 % of the brightest has passed a bubble. It gets the value of the other end; and
/// near bubbles at both ends of a line, where that is still brighter than the bodies that the other rays show, their
/// projection [MEY10]. Where this is more than 10 % of the rays nothing is replaced. Returns the share.
double remove_bubbles(const tomo::ParallelGeometry& geometry, std::vector<Image>& sinograms, std::span<const int> rows);
inline constexpr double most_bubbles = 0.1;

}  // namespace vam::metrology
