// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/radon_choice.hpp"

#include "testing.hpp"

using namespace vam::tomo;

namespace {

ParallelGeometry full_turn(int n, int angles) {
  return {n, n, n, angles, 0.5 * (n - 1), 0.5 * (n - 1), 0, 2 * std::numbers::pi / angles, 0};
}

bool fourier_wins(int n, int angles, std::size_t slabs) {
  const RadonCost cost = radon_cost(full_turn(n, angles), slabs);
  return cost.fourier < cost.footprints;
}

}  // namespace

// As measured, where one is at least 1.4 times as quick as the other.
TEST_CASE("large slices at many angles go by Fourier, small ones or few angles by footprints") {
  CHECK(fourier_wins(512, 360, 4));
  CHECK(fourier_wins(1024, 360, 1));
  CHECK(fourier_wins(128, 360, 1));
  CHECK(!fourier_wins(128, 32, 1));
  CHECK(!fourier_wins(512, 16, 1));
  CHECK(!fourier_wins(32, 360, 1));
}

TEST_CASE("a slice alone costs the Fourier slices a fraction of 16") {
  const RadonCost all = radon_cost(full_turn(512, 360), 1);
  const RadonCost one = radon_cost(full_turn(512, 360), 1, FourierRadon::Slices::one);
  CHECK(one.footprints == all.footprints);
  CHECK(one.fourier < all.fourier / 3);
}
