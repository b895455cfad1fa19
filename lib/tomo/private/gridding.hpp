// SPDX-License-Identifier: GPL-3.0-or-later
// The Kaiser-Bessel kernel by which values between the points of a zero-padded transform are interpolated [FS03]. A
// kernel of 6 points on a grid of 1.3 times as many points as pixels errs by about 1e-4 (RMS; 4e-4 at the image's
// edge), as one of 5 points does at 1.6 and one of 4 at 2.4, with more memory and longer transforms.
#pragma once

#include <vector>

#include "tomo/private/fourier_kernel.hpp"

namespace vam::tomo {

/// A length of 2^a 3^b 5^c 7^d, even, >= least: short factors are quick to transform, and few lengths are far apart.
[[nodiscard]] int smooth_length(int least);

/// The grid's points along an axis on which the image has `pixels`.
[[nodiscard]] int grid_points(int pixels);

/// The kernel's taps as polynomials of where the point lies between two grid points.
[[nodiscard]] const TapPolynomials& tap_polynomials();

/// 1 / transform of the kernel at pixels 0 .. pixels - 1, of which `centre` has the phase 0: interpolation in the
/// transform multiplies the image by the kernel's, which this undoes before.
[[nodiscard]] std::vector<float> deapodisation(int pixels, int centre, int points);

}  // namespace vam::tomo
