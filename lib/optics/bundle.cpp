// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/bundle.hpp"

#include <cmath>

#include "optics/skew_ray.hpp"

namespace vam::optics {

Bundle bundle(const View& view, double x_p_mm, double focus_mm) {
  constexpr double small_rad = 1e-5;  // central differences to 1e-9
  const double slope = chief_slopes(view, x_p_mm, 0).x;
  const auto beside = [&](double angle_rad) {
    const double other = std::tan(std::atan(slope) + angle_rad);
    return ray_of_slopes(view, x_p_mm - focus_mm * (other - slope), 0, {other, 0});
  };
  const SkewRay right = beside(small_rad);
  const SkewRay left = beside(-small_rad);
  const double climb = small_rad * std::sqrt(1 + slope * slope);
  const SkewRay above = ray_of_slopes(view, x_p_mm, -focus_mm * climb, {slope, climb});
  if (!right.hits || !left.hits || !above.hits) return {};
  return {true, (right.offset_mm - left.offset_mm) / (2 * small_rad),
          (right.delta_rad - left.delta_rad) / (2 * small_rad), above.height_mm / small_rad, above.climb / small_rad};
}

}  // namespace vam::optics
