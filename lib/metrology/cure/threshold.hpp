// SPDX-License-Identifier: GPL-3.0-or-later
// The gelation threshold I_p from a printed standard cylinder [OST22 section S2].
#pragma once

#include "base/image.hpp"
#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// A circle in pixels, centre of pixel (0, 0) at (0, 0).
struct FittedCircle {
  double x = 0;
  double y = 0;
  double radius = 0;
  double sigma = 0;  // RMS distance of the edge points from it
};

/// The strongest circle of an image with one bright (or dark) disc: Hough transform on the gradient (OpenCV), then
/// least squares on sub-pixel edge points along its radii. Throws Fault::data when there is none with a radius between
/// 4 pixels and half the image.
[[nodiscard]] FittedCircle find_circle(const Image& image);

/// The mean of a volume along z over the standard's own height, and that height: slices that hold at least half of
/// what the fullest does, without a tenth of them at either end. What lies above and below would thin the mean.
struct OverheadMean {
  Image mean;  // columns along x, y upwards
  double height_mm = 0;
};
[[nodiscard]] OverheadMean overhead_mean(const model::Volume& scatter);

/// Threshold from the standard: the mean of the overhead mean projection under the circle of the true diameter, centred
/// on the circle that the projection itself shows. Throws Fault::data where either circle is cut by the circle that
/// the volume fills.
struct Threshold {
  double isovalue = 0;              // I_p
  double spread = 0;                // standard deviation along the circle
  FittedCircle circle;              // in pixels of the overhead projection, with the true radius
  double diameter_mm = 0;           // true
  double apparent_diameter_mm = 0;  // of the steepest edge in the projection
};
[[nodiscard]] Threshold gelation_threshold(const Image& overhead_mean, double pixel_mm, double diameter_mm);

[[nodiscard]] Json to_json(const Threshold& threshold);

}  // namespace vam::metrology
