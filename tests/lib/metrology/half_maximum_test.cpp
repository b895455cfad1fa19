// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/half_maximum.hpp"

#include "testing.hpp"

using namespace vam::metrology;

TEST_CASE("Half maximum: between pixels, and only with dark on both sides") {
  std::vector<double> profile(40);
  for (int i = 0; i < 40; ++i) profile[i] = 5 + 100 * std::clamp(10.0 - std::abs(i - 20.25), 0.0, 4.0) / 4;
  const auto extent = half_maximum(profile);
  REQUIRE(extent);
  CHECK(extent->middle() == doctest::Approx(20.25));
  CHECK(extent->width() == doctest::Approx(16));
  CHECK(extent->centroid == doctest::Approx(20.25));
  CHECK_FALSE(half_maximum(std::vector<double>(40, 3)));
  std::vector<double> step(40);
  for (std::size_t i = 20; i < 40; ++i) step[i] = 1;
  CHECK_FALSE(half_maximum(step));
}

TEST_CASE("Half maximum: the centroid of a round top scatters less than half as far as the middle of its edges") {
  std::mt19937_64 random(29);
  std::uniform_real_distribution<double> part;
  std::normal_distribution<double> unit;
  double of_middle = 0;
  double of_centroid = 0;
  for (int run = 0; run < 200; ++run) {
    const double truth = 100 + part(random);
    std::vector<double> profile(200);
    for (int i = 0; i < 200; ++i) {
      profile[i] = 5 + 100 * std::sqrt(std::max(0.0, 1 - std::pow((i - truth) / 27, 2))) + unit(random);
    }
    const auto extent = half_maximum(profile);
    REQUIRE(extent);
    of_middle += std::pow(extent->middle() - truth, 2);
    of_centroid += std::pow(extent->centroid - truth, 2);
  }
  CHECK(of_centroid < of_middle / 4);
}
