// SPDX-License-Identifier: GPL-3.0-or-later
// Cubic convolution with a = -1/2: values between samples, exact for quadratics [KEYS81].
#pragma once

#include <array>
#include <cmath>

namespace vam {

/// k(d), d in samples [physics §3].
inline double cubic_kernel(double d) {
  const double x = std::abs(d);
  if (x < 1) return (1.5 * x - 2.5) * x * x + 1.0;
  if (x < 2) return ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0;
  return 0;
}

/// k at 1 + f, f, 1 - f and 2 - f: weights of the samples -1, 0, 1, 2 about the fraction f, 0 to 1.
inline std::array<float, 4> cubic_weights(float f) {
  const float g = 1 - f;
  return {-0.5F * f * g * g, 1 - 2.5F * f * f + 1.5F * f * f * f, 1 - 2.5F * g * g + 1.5F * g * g * g,
          -0.5F * g * f * f};
}

}  // namespace vam
