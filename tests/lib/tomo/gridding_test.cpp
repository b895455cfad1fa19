// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/private/gridding.hpp"

#include <complex>

#include "testing.hpp"

using namespace vam::tomo;

namespace {

/// Largest prime factor.
int roughness(int length) {
  int rough = 1;
  for (int factor = 2; length > 1; ++factor) {
    for (; length % factor == 0; length /= factor) rough = factor;
  }
  return rough;
}

}  // namespace

TEST_CASE("the taps carry the phase of any pixel to any place between grid points") {
  const int pixels = 100;
  const int centre = 50;
  const int points = grid_points(pixels);
  const auto undo = deapodisation(pixels, centre, points);
  double square = 0;
  int count = 0;
  for (int i = 0; i < pixels; ++i) {
    const double cycles = static_cast<double>(i - centre) / points;  // a grid point
    for (int step = 0; step < 64; ++step) {
      const double place = (step + 0.5) / 64;  // after grid point 0
      std::complex<double> sum = 0;
      for (int tap = 0; tap < grid_taps; ++tap) {
        double weight = 0;
        for (const auto& power : tap_polynomials().tap)
          weight = weight * (2 * place - 1) + static_cast<double>(power[tap]);
        sum += weight * std::polar(1.0, -2 * std::numbers::pi * cycles * (tap - taps_before));
      }
      const std::complex<double> exact = std::polar(1.0, -2 * std::numbers::pi * cycles * place);
      const double error = std::abs(static_cast<double>(undo[i]) * sum - exact);
      square += error * error;
      CHECK(error < 1e-3);
      ++count;
    }
  }
  // The aliases that a kernel of 6 points lets through at 1.3.
  CHECK(std::sqrt(square / count) < 2e-4);
}

TEST_CASE("lengths are even, smooth, and the next ones") {
  for (int least = 1; least < 700; ++least) {
    int expected = least + least % 2;
    while (roughness(expected) > 7) expected += 2;
    CHECK(smooth_length(least) == expected);
  }
  CHECK(grid_points(512) == 672);
  CHECK(grid_points(1) >= 2 * grid_taps);  // a margin holds no point twice
}
