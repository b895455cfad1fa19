// SPDX-License-Identifier: GPL-3.0-or-later
// A print in two parts gives the light of one in whole.
#include "device/open/open.hpp"
#include "device/projector/player.hpp"
#include "lib/device/steady_angle.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;

namespace {

struct Killed {};

// A print of 36 frames a turn at 30 deg/s and 60 Hz, killed after so many lit flips (-1: never), its blanks shifted by
// `phase_s` against the stage. Adds to each frame the time that it was on; returns the angle where the rest begins.
double play_part(double from_deg, int turns, long killed_after, double phase_s, std::vector<double>& seconds) {
  VirtualClock clock;
  const auto display = open_display("null:", {4, 4, 60}, clock, nullptr);
  for (int i = 0; i < 36; ++i) display->add(GreyImage(4, 4, 8));
  Steady angles(clock.now_s() + 2 + phase_s);
  PlayPlan plan{.frames_per_turn = 36, .turns = turns, .from_deg = from_deg};
  FlipRecord last;
  long lit = 0;
  const auto log = [&](const FlipRecord& record) {
    if (last.frame >= 0) seconds[static_cast<std::size_t>(last.frame)] += record.flip.time_s - last.flip.time_s;
    if (record.frame < 0 && lit > 0) {  // the black one of the end tells no angle
      last.frame = -1;
      return;
    }
    last = record;
    if (record.frame >= 0 && ++lit == killed_after) throw Killed{};
  };
  try {
    play(*display, nullptr, angles, clock, plan, log);
  } catch (const Killed&) {
  }
  return last.angle_deg + 0.5 * 30 / 60;
}

}  // namespace

TEST_CASE("A print killed at a random moment and resumed exposes each frame as an uninterrupted one does") {
  std::vector<double> whole(36);
  play_part(0, 3, -1, 0, whole);
  CHECK(whole[7] == doctest::Approx(3 * 20 / 60.0).epsilon(1e-6));
  std::mt19937 random(14);
  for (int trial = 0; trial < 20; ++trial) {
    const auto killed_after = std::uniform_int_distribution<long>(1, 3 * 720 - 2)(random);
    CAPTURE(killed_after);
    std::vector<double> both(36);
    const double end_deg = play_part(0, 3, killed_after, 0, both);
    const int done = static_cast<int>(end_deg / 360);
    play_part(end_deg - 360 * done, 3 - done, -1, std::uniform_real_distribution(0.0, 1 / 60.0)(random), both);
    for (int i = 0; i < 36; ++i) CHECK(std::abs(both[i] - whole[i]) < 1.01 / 60);  // one blank
  }
}
