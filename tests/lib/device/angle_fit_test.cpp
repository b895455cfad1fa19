#include "device/stage/angle_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "base/error.hpp"
#include "fault_of.hpp"

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
  CHECK(parse_angle_line(R"({"t_monotonic_s":1,"angle_deg":2,"sigma":0.5})", 1).sigma_deg == 0.5);  // of 0.1.0
  CHECK(to_line({1, 2, 3, true}).find(R"(,"ramp":true)") != std::string::npos);
  CHECK(parse_angle_line(to_line({1, 2, 3, true}), 1).ramp);
  CHECK_FALSE(back.ramp);
  for (const char* bad : {"", "7", "{}", R"({"t_monotonic_s":1,"angle_deg":"x","sigma_deg":1})",
                          R"({"t_monotonic_s":1e999,"angle_deg":1,"sigma_deg":1})", "{\"t_mono"}) {
    CAPTURE(bad);
    CHECK(fault_of([&] { (void)parse_angle_line(bad, 7); }) == Fault::data);
    CHECK(message_of([&] { (void)parse_angle_line(bad, 7); }).find("line 7") != std::string::npos);
  }
}

TEST_CASE("A sample has the time of the middle of its query, and what is beyond the shortest one as uncertainty") {
  RoundTrips trips;
  const AngleSample first = trips.timed({90, 10.000, 10.012}, 25);
  CHECK(first.t_s == doctest::Approx(10.006));
  CHECK(first.sigma_deg == doctest::Approx(25 * 0.012 / std::sqrt(12.0)).epsilon(1e-3));
  for (int i = 0; i < 10; ++i) (void)trips.timed({90, 10.0, 10.004}, 25);
  CHECK(trips.timed({90, 10.0, 10.004}, 25).sigma_deg ==
        doctest::Approx(25 * 0.004 / 3 / std::sqrt(12.0)).epsilon(1e-3));
  CHECK(trips.timed({90, 10.0, 10.024}, 25).sigma_deg ==
        doctest::Approx(25 * std::hypot(0.020, 0.004 / 3) / std::sqrt(12.0)).epsilon(1e-3));
}

TEST_CASE("On which way a round trip takes longer is learned, and the angle is not moved by it") {
  // 3 ms there and 2 ms back, and up to 20 ms more: of the answer, of the question, of either.
  const auto turned = [](double late_answers, double speed_deg_s, bool ripples) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto angle = [&](double t_s) {
      return speed_deg_s * (t_s + (ripples ? 5e-3 * std::sin(2 * std::numbers::pi * t_s) : 0));
    };
    RoundTrips trips;
    AngleFit line;
    AngleFit all(1e9);
    for (int i = 0; i < 1000; ++i) {
      const double asked_s = 0.03 * i;
      const double late_s = 0.02 * unit(random);
      const bool answer = unit(random) < late_answers;
      const double read_s = asked_s + 0.003 + (answer ? 0 : late_s);
      const AngleSample now = trips.timed({angle(read_s), asked_s, asked_s + 0.005 + late_s}, speed_deg_s);
      learn(trips, line);
      if (i >= 300) all.add(now);
    }
    const double by_ms = 1e3 * (all.at(19.5).angle_deg - angle(19.5)) / speed_deg_s;
    return std::pair(trips.share(), by_ms);
  };
  constexpr double unequal_ways_ms = 0.5;  // 3 and 2 ms are not known
  for (const double speed : {25.0, -60.0, 6.0}) {
    for (const bool ripples : {false, true}) {
      CAPTURE(speed);
      CAPTURE(ripples);
      const auto [answers, late_ms] = turned(1, speed, ripples);
      CHECK(answers < -0.45);
      CHECK(std::abs(late_ms - unequal_ways_ms) < 0.3);  // the ripple of 5 ms, in a line
      const auto [questions, early_ms] = turned(0, speed, ripples);
      CHECK(questions > 0.45);
      CHECK(std::abs(early_ms - unequal_ways_ms) < 0.3);
      CHECK(std::abs(turned(0.5, speed, ripples).first) < 0.1);
    }
  }
  RoundTrips standing;
  AngleFit line;
  for (int i = 0; i < 100; ++i) {
    (void)standing.timed({10 + 1e-4 * (i % 3), 0.1 * i, 0.1 * i + 1e-3 * (i % 7)}, 0);
    learn(standing, line);
  }
  CHECK(standing.share() == 0);
}

TEST_CASE("Answers that are read late do not move the angle to one side by more than a third of their delay") {
  // 3 ms there and 2 ms back, and up to 20 ms more until a busy machine reads them: the mean midpoint is 4.5 ms late.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> late_s(0, 0.02);
  RoundTrips trips;
  AngleFit fit(1e9);
  for (int i = 0; i < 1000; ++i) {
    const double asked_s = 0.03 * i;
    fit.add(trips.timed({25 * (asked_s + 0.003), asked_s, asked_s + 0.005 + late_s(random)}, 25));
  }
  const double by_ms = 1e3 * (fit.at(15).angle_deg - 25 * 15) / 25;
  CHECK(by_ms < 0);
  CHECK(by_ms > -0.3 * 4.5);
}
