// The projector's beam: the image of one lit column on a sensor that is moved along the light [RAY21 appendix 3].
#pragma once

#include <vector>

#include "base/image.hpp"
#include "metrology/curve_fit.hpp"

namespace vam::metrology {

/// Full width at half maximum of the bright vertical line in a picture, in pixels. Eight groups of rows give the
/// scatter. Throws Fault::data when there is no line with dark sides, or fewer than 16 rows.
[[nodiscard]] Measured line_width_px(const Image& picture, const std::string& subject);

struct BeamWidths {
  std::vector<double> plane_mm;  // along the light, 0 at the rotation axis
  std::vector<Measured> fwhm_mm;
};

struct Beam {
  Measured waist_mm;        // smallest width
  Measured focus_mm;        // where it is
  Measured axis_fwhm_mm;    // width at the axis
  Measured divergence_deg;  // atan of width over distance from the focus, far from it [RAY21 eq 10]
};

/// Fits w^2 = waist^2 + (divergence (y - focus))^2. Throws Fault::data: fewer than 4 planes, or widths that do not grow
/// to either side.
[[nodiscard]] Beam measure_beam(const BeamWidths& widths);

}  // namespace vam::metrology
