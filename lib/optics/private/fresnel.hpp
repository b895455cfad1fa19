// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel transmittance T of an interface between two media [physics §2].
#pragma once

namespace vam::optics {

/// Of unpolarised intensity, 1 - (r_s^2 + r_p^2) / 2, with the cosines of the angles before and after the interface.
inline double fresnel(double n1, double cos1, double n2, double cos2) {
  const double r_s = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
  const double r_p = (n1 * cos2 - n2 * cos1) / (n1 * cos2 + n2 * cos1);
  return 1.0 - 0.5 * (r_s * r_s + r_p * r_p);
}

}  // namespace vam::optics
