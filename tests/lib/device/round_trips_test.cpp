// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/round_trips.hpp"

#include <utility>

#include "device/stage/angle_fit.hpp"
#include "device/stage/private/ripple_filter.hpp"
#include "testing.hpp"

using namespace vam::device;

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
    RippleFilter middles;
    AngleFit all(1e9);
    for (int i = 0; i < 1000; ++i) {
      const double asked_s = 0.03 * i;
      const double late_s = 0.02 * unit(random);
      const bool answer = unit(random) < late_answers;
      const double read_s = asked_s + 0.003 + (answer ? 0 : late_s);
      const AngleSample now = trips.timed({angle(read_s), asked_s, asked_s + 0.005 + late_s}, speed_deg_s);
      learn(trips, middles);
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
  RippleFilter middles;
  for (int i = 0; i < 100; ++i) {
    (void)standing.timed({10 + 1e-4 * (i % 3), 0.1 * i, 0.1 * i + 1e-3 * (i % 7)}, 0);
    learn(standing, middles);
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
