#include "device/stage/angle_source.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>

#include "base/error.hpp"
#include "fault_of.hpp"

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
    CHECK(message_of([&] { angles->update(); }).find("none for 0.5 s after line 101") != std::string::npos);
    close(line[1]);
    CHECK(message_of([&] { angles->update(); }).find("ended") != std::string::npos);
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
