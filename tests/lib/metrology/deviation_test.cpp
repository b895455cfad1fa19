// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/deviation.hpp"

#include "lib/meshes.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "testing.hpp"

using namespace vam;

TEST_CASE("two equal spheres, one shifted: closed form") {
  // At radius R and shift d, the distance |p| - R has mean d^2/(3R) and RMS d/sqrt(3). 120 rings leave the facets
  // R (pi/120)^2 / 4 = 9e-4 inside the sphere, on both; 40,000 samples leave d/sqrt(3)/200 = 1.4e-3 of chance.
  const double radius = 5;
  const double shift = 0.5;
  const auto design = test::sphere({0, 0, 0}, radius, 120);
  const solid::Surface surface(design);
  const auto found =
      metrology::compare(metrology::measure(test::sphere({0, 0, shift}, radius, 120), design, surface, 40000));
  CHECK(found.print_to_design.rms_mm == doctest::Approx(shift / std::sqrt(3.0)).epsilon(0.005));
  CHECK(found.print_to_design.mean_mm == doctest::Approx(shift * shift / (3 * radius)).scale(1).epsilon(0.003));
  CHECK(found.print_to_design.max_mm == doctest::Approx(shift).epsilon(0.005));
  CHECK(found.hausdorff_mm == doctest::Approx(shift).epsilon(0.005));
  CHECK(found.largest_dimension_mm == doctest::Approx(2 * radius));
  // The way back mirrors it: the print stands out where its centre moved to.
  CHECK(found.design_to_print.rms_mm == doctest::Approx(shift / std::sqrt(3.0)).epsilon(0.005));
  CHECK(found.design_to_print.mean_mm == doctest::Approx(-shift * shift / (3 * radius)).scale(1).epsilon(0.003));
}

TEST_CASE("distances to an enlarged sphere are positive in both directions") {
  const auto design = test::sphere({1, 2, 3}, 5, 120);
  const solid::Surface surface(design);
  const auto found = metrology::compare(metrology::measure(test::sphere({1, 2, 3}, 5.2, 120), design, surface, 10000));
  for (const auto& d : {found.print_to_design, found.design_to_print}) {
    CHECK(d.mean_mm == doctest::Approx(0.2).epsilon(0.005));  // chord error 1e-3 of 0.2
    CHECK(d.sigma_mm < 1e-3);
    CHECK(d.min_mm > 0.19);
  }
}

TEST_CASE("a print that shrinks along each axis by another amount, grown by nothing") {
  model::TriangleSoup design;
  test::add_box({-5, -3, 0}, {5, 3, 4}, design);
  test::add_box({-1, 3, 0}, {1, 6, 2}, design);
  model::TriangleSoup print = design;
  for (auto& p : print.points) p = {0.99 * p[0] + 0.01, 0.98 * p[1] - 0.02, 0.96 * p[2]};
  const auto found = metrology::compare(metrology::measure(print, design, solid::Surface(design), 40000));
  // Linear in 4 %: products of the second order, 0.16 %, and what closest points near edges do to a few samples.
  CHECK(found.shrinkage_percent[0] == doctest::Approx(1).epsilon(0.1));
  CHECK(found.shrinkage_percent[1] == doctest::Approx(2).epsilon(0.1));
  CHECK(found.shrinkage_percent[2] == doctest::Approx(4).epsilon(0.1));
}

TEST_CASE("the turn that an alignment leaves in a part that shrinks unevenly is none of its shrinkage") {
  model::TriangleSoup design;
  test::add_box({-5, -3, 0}, {5, 3, 4}, design);
  test::add_box({-1, 3, 0}, {1, 6, 2}, design);
  model::TriangleSoup print = design;
  constexpr double turn = 1e-3;  // about what unlike faces pull an alignment by
  for (auto& p : print.points) {
    const Vector3 small{0.99 * p[0], 0.98 * p[1], 0.97 * p[2]};
    p = small + cross({turn, -turn, turn}, small);
  }
  const auto found = metrology::compare(metrology::measure(print, design, solid::Surface(design), 40000));
  // The turn moves the ends by 0.1 %; its square is 1e-4 %.
  CHECK(found.shrinkage_percent[0] == doctest::Approx(1).epsilon(0.002));
  CHECK(found.shrinkage_percent[1] == doctest::Approx(2).epsilon(0.002));
  CHECK(found.shrinkage_percent[2] == doctest::Approx(3).epsilon(0.002));
}

TEST_CASE("a slender print that shrinks along its length alone, with a crumb on its side") {
  model::TriangleSoup design;
  test::add_box({-1, -1, -10}, {1, 1, 10}, design);
  model::TriangleSoup print = design;
  for (auto& p : print.points) p[2] *= 0.98;
  test::add_box({1.5, -0.3, 2}, {2.1, 0.3, 2.6}, print);
  const auto found = metrology::compare(metrology::measure(print, design, solid::Surface(design), 40000));
  // Samples near the ends' edges see the side before the end: some per cent of the ends' 2.5 % of the area.
  CHECK(found.shrinkage_percent[0] == doctest::Approx(0).scale(1).epsilon(0.1));
  CHECK(found.shrinkage_percent[1] == doctest::Approx(0).scale(1).epsilon(0.1));
  CHECK(found.shrinkage_percent[2] == doctest::Approx(2).epsilon(0.1));
}

TEST_CASE("robust figures: a crumb does not decide them") {
  std::vector<float> values(100, 0.1F);
  values[7] = 5;
  values[31] = -3;
  const auto d = metrology::deviation(values);
  CHECK(d.rms_mm > 0.5);
  CHECK(d.trimmed_mm == doctest::Approx(0.1));
  CHECK(metrology::within_percent(values, 0.1001) == doctest::Approx(98));
  CHECK(metrology::within_percent(values, 0.05) == doctest::Approx(0));
}

TEST_CASE("statistics of given numbers") {
  const std::vector<float> values{-2, -1, 0, 1, 7};
  const auto d = metrology::deviation(values);
  CHECK(d.mean_mm == doctest::Approx(1));
  CHECK(d.rms_mm == doctest::Approx(std::sqrt(55.0 / 5)));
  CHECK(d.sigma_mm == doctest::Approx(std::sqrt(10.0)));
  CHECK(d.mad_mm == doctest::Approx(1));
  CHECK(d.max_abs_mm == 7);
  // Between -2 and -1, and between 1 and 7, at 4 x 0.05 and 4 x 0.95.
  CHECK(d.percentiles_mm[1].second == doctest::Approx(-1.8));
  CHECK(d.percentiles_mm[3].second == doctest::Approx(0));
  CHECK(d.percentiles_mm[5].second == doctest::Approx(5.8));
  CHECK_THROWS_AS((void)metrology::deviation({}), Error);
}

TEST_CASE("colours: blue inside, white at zero, red outside") {
  CHECK(metrology::blue_white_red(-2, 1) == std::array<std::uint8_t, 3>{0, 0, 255});
  CHECK(metrology::blue_white_red(0, 1) == std::array<std::uint8_t, 3>{255, 255, 255});
  CHECK(metrology::blue_white_red(1, 1) == std::array<std::uint8_t, 3>{255, 0, 0});
}
