// SPDX-License-Identifier: GPL-3.0-or-later
// Projections in the grey levels that the projector has.
#pragma once

#include <span>

#include "base/image.hpp"
#include "resin/response.hpp"

namespace vam::optimize {

/// Of all images; 0 where none is lit.
[[nodiscard]] double largest(std::span<const Image> images);

/// Rounds fluence to the intensities of a projector's grey levels, full grey at `full_scale`; 0: nothing is lit. With
/// error feedback what rounding leaves over goes to the neighbouring columns and angles (resin::Dither), so that sums
/// over angles, which are the dose, stay right.
void quantise(std::span<Image> images, const resin::GreyLevels& levels, double full_scale, bool error_feedback);

}  // namespace vam::optimize
