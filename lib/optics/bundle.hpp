// SPDX-License-Identifier: GPL-3.0-or-later
// The rays beside a chief ray: a lens has an aperture, and each point of the image receives a bundle.
#pragma once

#include "optics/chief_ray.hpp"

namespace vam::optics {

/// How the line of a pixel's ray in the resin changes with the angle in air between it and the chief ray, all of them
/// through the pixel's image. Seen from above it is x_v + a offset_rate, delta + a delta_rate, a being the angle;
/// along z it is higher by e (height_rate + u climb_rate), e being the tangent of the elevation [physics §4].
struct Bundle {
  bool hits = false;
  double offset_rate_mm = 0;
  double delta_rate = -1;
  double height_rate_mm = 0;
  double climb_rate = 0;
};

/// The bundle of a level chief ray; the image is in the plane focus_mm behind the axis, in air.
[[nodiscard]] Bundle bundle(const View& view, double x_p_mm, double focus_mm);

}  // namespace vam::optics
