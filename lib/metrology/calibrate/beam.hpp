// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's beam: the image of one lit column on a sensor that is moved along the light [RAY21 appendix 3], or of
// one lit row in fluorescing resin, which a camera at the side sees in all planes at once.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "base/stats/measured.hpp"
#include "model/printer.hpp"

namespace vam::metrology {

/// Full width at half maximum of the bright vertical line in an image, in pixels. Eight groups of rows give the
/// scatter. Throws Fault::data when there is no line with dark sides, or fewer than 16 rows.
[[nodiscard]] stats::Measured line_width_px(const Image& image, const std::string& subject);

struct BeamWidths {
  std::vector<double> plane_mm;  // along the light, 0 at the rotation axis
  std::vector<stats::Measured> fwhm_mm;
};

/// A camera that looks at the resin from the side, square to the light.
struct SideView {
  double pixel_mm = 0;     // at the axis
  double axis_column = 0;  // of the image
};

/// The width of a lit row in up to `planes` planes between -0.8 and 0.8 of the resin's radius, by a Gaussian that is
/// summed over the camera's rows. Columns become distances along the light by the camera's rays (`printer` gives vial,
/// indices and camera), rows become heights by [OST22 eq S6]. Throws Fault::data: a camera more than 10 degrees off the
/// right angle, fewer than 8 columns a plane for four planes, or no line.
[[nodiscard]] BeamWidths side_widths(const Image& image, const SideView& view, const model::Printer& printer,
                                     int planes);

struct MeasuredBeam {
  stats::Measured waist_mm;        // smallest width
  stats::Measured focus_mm;        // where it is
  stats::Measured axis_fwhm_mm;    // width at the axis
  stats::Measured divergence_deg;  // atan of width over distance from the focus, far from it [RAY21 eq 10]
};

/// Fits w^2 = waist^2 + (divergence (y - focus))^2. Throws Fault::data: fewer than 4 planes, or widths that do not grow
/// to either side.
[[nodiscard]] MeasuredBeam measure_beam(const BeamWidths& widths);

}  // namespace vam::metrology
