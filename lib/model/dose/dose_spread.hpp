// SPDX-License-Identifier: GPL-3.0-or-later
// How far the dose of a print is smeared in the end [physics §4].
#pragma once

#include "model/printer.hpp"

namespace vam::model {

/// Mean square, in mm2 along one axis, of how far what absorbed the light has diffused when the part is rinsed, after a
/// print of `seconds`, lit evenly throughout, and the dark: it diffuses from when it was lit until it dies or is
/// rinsed.
[[nodiscard]] double diffused_mm2(const Resin& resin, double seconds);

/// Standard deviation in mm along one axis, by the point spread of the beam and diffusion together.
[[nodiscard]] double spread_mm(const Resin& resin, double seconds);

/// Once a run, where diffusion blurs the dose of a print of `seconds`: it is not taken for more than it stands for.
void warn_of_diffusion(const Resin& resin, double seconds);

}  // namespace vam::model
