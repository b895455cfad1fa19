// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/projector/player.hpp"

#include <memory>

#include "base/text/json.hpp"
#include "device/open/open.hpp"
#include "device/projector/light_engine.hpp"
#include "lib/device/steady_angle.hpp"
#include "sim/controllers/dlp.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;
using namespace vam::sim;

TEST_CASE("Light only from angle 0 to the last turn's end, and black after") {
  VirtualClock clock;
  std::vector<Json> leds;
  const auto light =
      make_dlp_light(make_sim_dlp({}, [&](const Json& line) { leds.push_back(line); }), {}, clock, nullptr);
  light->prepare();
  leds.clear();
  const auto display = open_display("null:", {4, 4, 60}, clock, nullptr);
  for (int i = 0; i < 360; ++i) display->add(GreyImage(4, 4, 8));
  const double zero_s = clock.now_s() + 14;
  Steady angles(zero_s);
  PlayPlan plan{.turns = 2};
  std::vector<FlipRecord> records;
  const PlayTally tally =
      play(*display, light.get(), angles, clock, plan, [&](const FlipRecord& record) { records.push_back(record); });
  REQUIRE(leds.size() == 2);
  CHECK(leds[0]["bits"] == 4);
  CHECK(leds[1]["bits"] == 0);
  CHECK(records.back().frame == -1);
  for (const auto& record : records) {
    const double angle_deg = 30 * (record.flip.time_s + 0.5 / 60 - zero_s);
    if (record.frame >= 0) {
      CHECK(angle_deg > -1e-6);
      CHECK(angle_deg < 720);
      CHECK(std::abs(std::remainder(angle_deg - record.frame, 360)) <= 0.5 + 1e-6);
    } else if (angle_deg > 0) {
      CHECK(angle_deg >= 720);
    }
  }
  CHECK(tally.lit == 2 * 12 * 60);  // 2 turns of 12 s at 60 Hz
  CHECK(tally.missed == 0);
}

TEST_CASE("Frames of two turns: those of the second in every other turn") {
  VirtualClock clock;
  const auto display = open_display("null:", {4, 4, 60}, clock, nullptr);
  PlayPlan plan{.frames_per_turn = 36, .frames = 72, .turns = 4};
  for (int i = 0; i < plan.frames; ++i) display->add(GreyImage(4, 4, 8));
  Steady angles(clock.now_s() + 14);
  int lit = 0;
  play(*display, nullptr, angles, clock, plan, [&](const FlipRecord& record) {
    if (record.frame < 0) return;
    ++lit;
    CHECK(record.frame == std::lround(record.angle_deg / 10) % 72);
  });
  CHECK(lit == 4 * 12 * 60);
}

namespace {

// A turn of 720 blanks after a run-up of 780, every miss-th flip one blank late; the LEDs from one
// change to the next.
PlayTally play_missing(int miss, double allowed_lit, std::vector<int>& leds) {
  VirtualClock clock;
  const auto note = [&](const Json& line) {
    if (line["event"] == "leds") leds.push_back(line["bits"]);
  };
  const auto light = make_dlp_light(make_sim_dlp({}, note), {}, clock, nullptr);
  light->prepare();
  leds.clear();
  const auto display = open_display("null:?miss=" + std::to_string(miss), {4, 4, 60}, clock, nullptr);
  display->add(GreyImage(4, 4, 8));
  Steady angles(clock.now_s() + 13);
  PlayPlan plan{.frames_per_turn = 1, .allowed_missed_lit = allowed_lit};
  return play(*display, light.get(), angles, clock, plan, [](const FlipRecord&) {});
}

// A null: display that remembers what is on.
class Watched final : public Display {
 public:
  explicit Watched(Clock& clock) : inner_(open_display("null:", {4, 4, 60}, clock, nullptr)) {}
  DisplayMode mode() const override { return inner_->mode(); }
  int add(const GreyImage& levels) override { return inner_->add(levels); }
  void exchange(ScreenFrames& frames) override { inner_->exchange(frames); }
  Flip present(int index) override {
    shown = index;
    lit = lit || index >= 0;
    return inner_->present(index);
  }
  int shown = 0;
  bool lit = false;

 private:
  std::unique_ptr<Display> inner_;
};

}  // namespace

TEST_CASE("Missed vertical blanks: in the run-up no light at all, in the print black where there are too many") {
  std::vector<int> leds;
  CHECK(fault_of([&] { play_missing(50, 0.01, leds); }) == Fault::busy);
  CHECK(std::count(leds.begin(), leds.end(), 0) == std::ssize(leds));
  CHECK(fault_of([&] { play_missing(1200, 0.001, leds); }) == Fault::busy);
  CHECK(leds.front() == 4);
  CHECK(leds.back() == 0);
}

TEST_CASE("A vertical blank may be missed in the print that may not be missed in the run-up") {
  std::vector<int> leds;
  CHECK(play_missing(1200, PlayPlan{}.allowed_missed_lit, leds).missed == 1);
}

TEST_CASE("Frames may be exchanged before the first frame of a turn, and nothing dark is between") {
  VirtualClock clock;
  Watched display(clock);
  for (int i = 0; i < 4; ++i) display.add(GreyImage(4, 4, 8));
  PlayPlan plan{.frames_per_turn = 4, .turns = 3, .from_deg = 90};
  std::vector<FlipRecord> flips;
  std::vector<std::pair<int, std::size_t>> turns;  // and the flips before
  plan.next_turn = [&](int turn) {
    turns.emplace_back(turn, flips.size());
    return 0;
  };
  const auto angles = elapsed_angle(90, clock);
  play(display, nullptr, *angles, clock, plan, [&](const FlipRecord& record) { flips.push_back(record); });
  REQUIRE(turns.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto [turn, before] = turns[i];
    CHECK(turn == static_cast<int>(i) + 1);
    CHECK(flips[before - 1].frame == 3);
    CHECK(flips[before].frame == 0);
    CHECK(std::abs(flips[before].angle_deg - (360.0 * turn - 45)) < 3);
  }
}

TEST_CASE("Frames may say for how many turns there is light, but not for more than was planned") {
  for (const int left : {1, 2, 9}) {
    VirtualClock clock;
    Watched display(clock);
    for (int i = 0; i < 4; ++i) display.add(GreyImage(4, 4, 8));
    PlayPlan plan{.frames_per_turn = 4, .turns = 5, .next_turn = [left](int turn) { return turn == 2 ? left : 0; }};
    double last_deg = 0;
    const auto angles = elapsed_angle(90, clock);
    play(display, nullptr, *angles, clock, plan, [&](const FlipRecord& record) {
      if (record.frame >= 0) last_deg = record.angle_deg;
    });
    CAPTURE(left);
    CHECK(last_deg > 360 * std::min(5, 2 + left) - 4);
    CHECK(last_deg < 360 * std::min(5, 2 + left));
  }
}

TEST_CASE("A light engine that fails in a print: the right fault, the screen black, the LEDs off where it answers") {
  const std::vector<std::pair<const char*, Fault>> cases{
      {"silent", Fault::busy},           {"late", Fault::busy},
      {"garbage", Fault::protocol},      {"truncated", Fault::protocol},
      {"wrong-sender", Fault::protocol}, {"error", Fault::protocol},
      {"unplug", Fault::absent}};
  for (const bool dlpc900 : {false, true}) {
    for (const auto& wrong : cases) {
      const char* kind = wrong.first;
      const Fault fault = wrong.second;
      for (const int after : {0, 1, 2, 3}) {  // writing and reading back: on, then off
        CAPTURE(dlpc900);
        CAPTURE(kind);
        CAPTURE(after);
        VirtualClock clock;
        std::vector<Json> leds;
        SimDlpSettings sim{.dlpc900 = dlpc900, .fault = kind};
        const int to_prepare = dlpc900 ? 24 : 16;  // reports
        sim.fault_after = to_prepare + after;
        auto light =
            make_dlp_light(make_sim_dlp(sim, [&](const Json& line) { leds.push_back(line); }), {}, clock, nullptr);
        light->prepare();
        Watched display(clock);
        display.add(GreyImage(4, 4, 8));
        PlayPlan plan{.frames_per_turn = 1};
        const auto angles = elapsed_angle(90, clock);
        CHECK(fault_of([&] { play(display, light.get(), *angles, clock, plan, [](const FlipRecord&) {}); }) == fault);
        CHECK(display.shown == -1);
        CHECK(display.lit == (after > 1));  // never an image unless the light was known to be right
        if (kind != std::string("unplug") && kind != std::string("error")) CHECK(leds.back()["bits"] == 0);
      }
    }
  }
}
