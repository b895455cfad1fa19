// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/angle_source.hpp"

#include <unistd.h>

#include "testing.hpp"

using namespace vam;
using namespace vam::device;

TEST_CASE("Followed lines: a prediction, then stale, ended or bad ones are errors") {
  std::array<int, 2> line{};
  const auto start = [&](VirtualClock& clock) {
    REQUIRE(pipe(line.data()) == 0);
    return followed_angle("/dev/fd/" + std::to_string(line[0]), clock, 26);
  };
  const auto say = [&](const std::string& text) {
    REQUIRE(write(line[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  };
  {
    VirtualClock clock(50);
    const auto angles = start(clock);
    angles->update();
    CHECK_FALSE(angles->at(50).has_value());
    for (int i = 0; i <= 100; ++i) say(to_line({50 + 0.01 * i, 0.25 * i, 0.01}));
    say("\n");  // to_line() has no LF of its own: what stands on one line is no line
    CHECK(fault_of([&] { angles->update(); }) == Fault::data);
    close(line[0]);
    close(line[1]);
  }
  {
    VirtualClock clock(50);
    const auto angles = start(clock);
    for (int i = 0; i <= 100; ++i) say(to_line({50 + 0.01 * i, 0.25 * i, 0.01}) + "\n");
    angles->update();
    REQUIRE(angles->at(51.1).has_value());
    CHECK(angles->at(51.1)->angle_deg == doctest::Approx(27.5));
    clock.sleep_until(50.4);
    angles->update();
    clock.sleep_until(50.6);
    CHECK(has(message_of([&] { angles->update(); }), "none for 0.5 s after line 101"));
    close(line[1]);
    CHECK(has(message_of([&] { angles->update(); }), "ended"));
    close(line[0]);
  }
  {  // a stage that has come where it must, and brakes: who is late still has the angles before
    VirtualClock clock(50);
    const auto angles = start(clock);
    for (int i = 0; i <= 104; ++i) say(to_line({50 + 0.01 * i, 0.25 * i, 0.01}) + "\n");
    angles->update();
    clock.sleep_until(52.5);
    CHECK_NOTHROW(angles->update());
    close(line[1]);
    CHECK_NOTHROW(angles->update());
    CHECK(angles->at(51.03)->angle_deg == doctest::Approx(25.75));
    close(line[0]);
  }
  VirtualClock clock;
  CHECK(fault_of([&] { (void)followed_angle("/nonexistent", clock, 26); }) == Fault::no_input);
}

TEST_CASE("What a stage does before it has its speed is not taken for its ripple") {
  // From -720 degrees on, at 200 deg/s2 to 30 deg/s, with angles as uncertain as those of late replies. Where the
  // second turn begins the ripple that the first one taught is used: there the error shows.
  const auto angle_deg = [](double t_s) { return -720 + (t_s < 0.15 ? 100 * t_s * t_s : 30 * t_s - 2.25); };
  const auto worst_deg = [&](bool marked) {
    std::array<int, 2> line{};
    REQUIRE(pipe(line.data()) == 0);
    VirtualClock clock;
    const auto angles = followed_angle("/dev/fd/" + std::to_string(line[0]), clock, 1e9);
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, 0.15);
    double worst = 0;
    for (double t_s = 0; t_s < 14; t_s += 0.02) {
      const std::string text = to_line({t_s, angle_deg(t_s) + normal(random), 0.15, marked && t_s < 0.4}) + "\n";
      REQUIRE(write(line[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
      angles->update();
      if (t_s > 10) worst = std::max(worst, std::abs(angles->at(t_s + 0.03)->angle_deg - angle_deg(t_s + 0.03)));
    }
    close(line[0]);
    close(line[1]);
    return worst;
  };
  CHECK(worst_deg(true) < 0.15);
  CHECK(worst_deg(false) > 0.25);
}

TEST_CASE("An angle by the time since the first look, and one that stands") {
  VirtualClock clock(50);
  const auto elapsed = elapsed_angle(-12, clock);
  CHECK_FALSE(elapsed->at(50));
  elapsed->update();
  clock.sleep_until(51);
  elapsed->update();  // the first counts
  CHECK(elapsed->at(52)->angle_deg == -24);
  CHECK(elapsed->at(52)->t_s == 52);
  const auto standing = standing_angle(7);
  standing->update();
  CHECK(standing->at(3)->angle_deg == 7);
  CHECK(standing->at(3)->sigma_deg == 0);
}

TEST_CASE("A line of a stage's angles: three finite numbers") {
  const AngleSample sample = parse_angle_line(R"({"t_monotonic_s":1.5,"angle_deg":-2,"sigma_deg":0.25})", 1);
  CHECK(sample.t_s == 1.5);
  CHECK(sample.angle_deg == -2);
  CHECK(sample.sigma_deg == 0.25);
  const auto back = parse_angle_line(to_line({1.25, 300, 0.5}), 1);
  CHECK(back.t_s == 1.25);
  CHECK(back.sigma_deg == 0.5);
  for (const char* line :
       {"", "[]", "{}", "{\"t_monotonic_s\":1,\"angle_deg\":\"1\",\"sigma_deg\":1}",
        "{\"t_monotonic_s\":1,\"angle_deg\":1}", "{\"t_monotonic_s\":1e999,\"angle_deg\":1,\"sigma_deg\":1}"}) {
    CAPTURE(line);
    CHECK(has(message_of([&] { (void)parse_angle_line(line, 12); }), "line 12: "));
  }
}
