// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/angle_fit.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::device;

TEST_CASE("Samples on a line give the line") {
  AngleFit fit(2);
  for (int i = 0; i <= 100; ++i) fit.add({1e5 + 0.01 * i, -3 + 25 * 0.01 * i, 0.01});
  REQUIRE(fit.ready());
  // Times of 1e5 s leave 1.5e-11 s of a double; at 25 deg/s that is 4e-10 deg, so 1e-8 is rounding alone.
  CHECK(fit.speed_deg_s() == doctest::Approx(25).epsilon(1e-9));
  CHECK(std::abs(fit.at(1e5 + 1.05).angle_deg - (-3 + 25 * 1.05)) < 1e-8);
}

TEST_CASE("The reported sigma covers the error of the prediction") {
  // 500 fits with Gaussian noise of the stated sigma: |error| <= 2 sigma in 95.4 % of them; the count has a standard
  // deviation of sqrt(500 * 0.954 * 0.046) = 4.7, so 3 of those below 477 is 463.
  std::mt19937_64 random(7);
  int inside = 0;
  for (int run = 0; run < 500; ++run) {
    AngleFit fit(1);
    for (int i = 0; i < 60; ++i) {
      const double sigma = i % 5 == 0 ? 0.2 : 0.02;  // every fifth answer comes late
      fit.add({0.01 * i, 10 * 0.01 * i + std::normal_distribution<double>(0, sigma)(random), sigma});
    }
    const AngleSample next = fit.at(0.62);
    if (std::abs(next.angle_deg - 6.2) <= 2 * next.sigma_deg) ++inside;
  }
  CHECK(inside >= 463);
}

TEST_CASE("The sigma of a line is that of its samples, or of their scatter where that is larger") {
  // Five samples 0.1 s apart: the sum of squares of their times from the middle is 0.1 s^2.
  const auto fitted = [](double scatter_deg) {
    constexpr double off[] = {1, -2, 0, 2, -1};  // orthogonal to every line; their squares add up to 10
    AngleFit fit;
    for (int i = 0; i < 5; ++i) fit.add({100 + 0.1 * i, 25 * 0.1 * i + scatter_deg * off[i], 0.03});
    return fit;
  };
  const AngleFit fine = fitted(0), rough = fitted(0.3);
  CHECK(fine.speed_sigma_deg_s() == doctest::Approx(0.03 / std::sqrt(0.1)).epsilon(1e-6));
  CHECK(fine.at(100.5).sigma_deg == doctest::Approx(0.03 * std::sqrt(1.0 / 5 + 0.09 / 0.1)).epsilon(1e-6));
  // Three degrees of freedom are left: a variance of 10 / 3 x 0.3^2 a sample.
  CHECK(rough.speed_deg_s() == doctest::Approx(25).epsilon(1e-9));
  CHECK(rough.speed_sigma_deg_s() == doctest::Approx(0.3 * std::sqrt(10.0 / 3 / 0.1)).epsilon(1e-6));
  CHECK(rough.at(100.2).sigma_deg == doctest::Approx(0.3 * std::sqrt(10.0 / 3 / 5)).epsilon(1e-6));
}

TEST_CASE("Old samples are forgotten and too few are not a line") {
  AngleFit fit(1);
  fit.add({0, 0, 0.01});
  fit.add({0.01, 1, 0.01});
  CHECK_FALSE(fit.ready());
  for (int i = 0; i <= 200; ++i) fit.add({5 + 0.01 * i, 7.0, 0.01});
  CHECK(fit.ready());
  CHECK(fit.at(8).angle_deg == doctest::Approx(7));
}

TEST_CASE("Lines of samples are written and read back unchanged") {
  const AngleSample sample{123.4567891, -12.34567, 0.00123};
  const AngleSample back = parse_angle_line(to_line(sample), 1);
  CHECK(back.t_s == sample.t_s);
  CHECK(back.angle_deg == sample.angle_deg);
  CHECK(back.sigma_deg == sample.sigma_deg);
  CHECK(has(to_line({1, 2, 3, true}), R"(,"ramp":true)"));
  CHECK(parse_angle_line(to_line({1, 2, 3, true}), 1).ramp);
  CHECK_FALSE(back.ramp);
  CHECK(to_line(sample, true) == R"({"t_monotonic_s":123.4567891,"angle_deg":-12.34567,"sigma_deg":0.00123,)"
                                 R"("schema":"vam-angles/1"})");
  CHECK(parse_angle_line(to_line(sample, true), 1).t_s == sample.t_s);
  for (const char* bad : {"", "7", "{}", R"({"t_monotonic_s":1,"angle_deg":"x","sigma_deg":1})",
                          R"({"t_monotonic_s":1e999,"angle_deg":1,"sigma_deg":1})", "{\"t_mono",
                          R"({"t_monotonic_s":1,"angle_deg":1,"sigma_deg":1,"schema":"vam-angles/2"})"}) {
    CAPTURE(bad);
    CHECK(fault_of([&] { (void)parse_angle_line(bad, 7); }) == Fault::data);
    CHECK(has(message_of([&] { (void)parse_angle_line(bad, 7); }), "line 7"));
  }
}
