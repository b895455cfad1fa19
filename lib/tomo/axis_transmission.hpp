// SPDX-License-Identifier: GPL-3.0-or-later
// What absorption leaves of parallel light on its way to the axis.
#pragma once

#include <vector>

namespace vam::tomo {

/// Throws Fault::data where e^{-mu R} is too small to divide by: resin that light does not get through.
void require_translucent(double mu_per_px, double resin_radius_px);

/// e^{rate sqrt(R^2 - t^2)} of each column, t = 0 in their middle: with rate = -mu the share of the light that reaches
/// the plane of the axis [physics §4], with rate = mu its inverse.
[[nodiscard]] std::vector<float> to_the_axis(int columns, double rate_per_px, double resin_radius_px);

}  // namespace vam::tomo
