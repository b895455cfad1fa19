// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/private/gridding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/index.hpp"

namespace vam::tomo {

namespace {

using std::numbers::pi;
constexpr double oversampling = 1.3;
constexpr double half_width = 0.5 * grid_taps;
// 0.98 of what puts the transform's first zero at the nearest alias of the image's edge: least error (RMS), by search.
constexpr double beta = 0.98 * pi * grid_taps * (1 - 0.5 / oversampling);

double kernel(double distance) {
  const double x = distance / half_width;
  return std::cyl_bessel_i(0, beta * std::sqrt(std::max(0.0, 1 - x * x))) / std::cyl_bessel_i(0, beta);
}

/// The kernel's transform at that frequency, in cycles per grid point; within the image it is below beta / (6 pi).
double transform(double frequency) {
  const double root = std::sqrt(beta * beta - std::pow(pi * grid_taps * frequency, 2));
  return grid_taps * std::sinh(root) / (root * std::cyl_bessel_i(0, beta));
}

/// Coefficients, the highest power first, of the polynomial through the kernel at the Chebyshev nodes of z in [-1, 1],
/// by Newton's divided differences.
std::array<double, tap_powers> fit(int tap) {
  std::array<double, tap_powers> z{};
  std::array<double, tap_powers> difference{};
  for (int i = 0; i < tap_powers; ++i) {
    z[i] = std::cos(pi * (i + 0.5) / tap_powers);
    difference[i] = kernel(tap - taps_before - 0.5 * (z[i] + 1));
  }
  for (int order = 1; order < tap_powers; ++order) {
    for (int i = tap_powers - 1; i >= order; --i)
      difference[i] = (difference[i] - difference[i - 1]) / (z[i] - z[i - order]);
  }
  std::array<double, tap_powers> ascending{};  // Horner on polynomials: p <- p (z - z_i) + difference_i
  for (int i = tap_powers - 1; i >= 0; --i) {
    for (int power = tap_powers - 1; power >= 0; --power) {
      ascending[power] = (power > 0 ? ascending[power - 1] : difference[i]) - z[i] * ascending[power];
    }
  }
  return ascending;
}

TapPolynomials make_polynomials() {
  TapPolynomials made{};
  for (int tap = 0; tap < grid_taps; ++tap) {
    const auto ascending = fit(tap);
    for (int p = 0; p < tap_powers; ++p) {
      const auto value = static_cast<float>(ascending[tap_powers - 1 - p]);
      made.tap[p][tap] = value;
      made.tap[p][8 + tap] = value;
    }
  }
  return made;
}

}  // namespace

int smooth_length(int least) {
  int best = std::numeric_limits<int>::max();
  for (int seven = 1; seven < 2 * least; seven *= 7) {
    for (int five = seven; five < 2 * least; five *= 5) {
      for (int three = five; three < 2 * least; three *= 3) {
        int length = 2 * three;
        while (length < least) length *= 2;
        best = std::min(best, length);
      }
    }
  }
  return best;
}

int grid_points(int pixels) { return smooth_length(std::max(ceil_int(oversampling * pixels), 2 * grid_taps)); }

const TapPolynomials& tap_polynomials() {
  static const TapPolynomials made = make_polynomials();
  return made;
}

std::vector<float> deapodisation(int pixels, int centre, int points) {
  std::vector<float> factors(pixels);
  for (int i = 0; i < pixels; ++i) {
    factors[i] = static_cast<float>(1 / transform(static_cast<double>(i - centre) / points));
  }
  return factors;
}

}  // namespace vam::tomo
