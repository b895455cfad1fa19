// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/patterns.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::optics;

namespace {

model::Projector small_projector() { return {.columns = 64, .rows = 48, .axis_column = 30, .axis_row = 20}; }

long lit(const GreyImage& image) {
  return std::count_if(image.values.begin(), image.values.end(), [](std::uint16_t level) { return level > 0; });
}

}  // namespace

TEST_CASE("The axis is a cross at the axis") {
  const GreyImage image = pattern_frame({"axis"}, small_projector(), 0);
  CHECK(lit(image) == 64 + 48 - 1);
  CHECK(image(30, 0) == 255);
  CHECK(image(0, 20) == 255);
  CHECK(image(31, 0) == 0);
}

TEST_CASE("A grid has a line at every pitch from the axis") {
  PatternPlan plan{"grid", 0.5};
  plan.pitch_px = 10;
  const GreyImage image = pattern_frame(plan, small_projector(), 0);
  for (int x = 0; x < 64; ++x) CHECK((image(x, 5) > 0) == (x % 10 == 0));  // row 5 has no line of its own
  CHECK(image(0, 5) == 128);
}

TEST_CASE("A ramp ends at black and at full and its steps are even") {
  PatternPlan plan{"ramp"};
  const auto projector = small_projector();
  CHECK(pattern_frames(plan, projector) == 17);
  CHECK(lit(pattern_frame(plan, projector, 0)) == 0);
  CHECK(pattern_frame(plan, projector, 8)(3, 3) == 128);
  CHECK(pattern_frame(plan, projector, 16)(63, 47) == 255);
}

TEST_CASE("A line is as wide as a sweep's step where neither is given, and as one says") {
  PatternPlan plan{"sweep"};
  set_lines(plan, {}, 7);
  CHECK(plan.pitch_px == sweep_line_px);
  CHECK(plan.width_px == 7);
  plan.name = "grid";
  set_lines(plan, {}, {});
  CHECK(plan.pitch_px == 16);
  CHECK(plan.width_px == 1);
}

TEST_CASE("A sweep lights every column exactly once") {
  PatternPlan plan{"sweep"};
  set_lines(plan, {}, {});
  const auto projector = small_projector();
  std::vector<int> times(64);
  for (int n = 0; n < pattern_frames(plan, projector); ++n) {
    const GreyImage image = pattern_frame(plan, projector, n);
    for (int x = 0; x < 64; ++x) times[x] += image(x, 7) > 0 ? 1 : 0;
  }
  CHECK(times == std::vector<int>(64, 1));
}

TEST_CASE("A star is half lit, in 36 sectors") {
  auto projector = small_projector();
  projector.columns = 401;
  projector.rows = 401;
  const GreyImage image = pattern_frame({"star"}, projector, 0);
  int changes = 0;  // around a circle of 180 px: every change of light is an edge of a spoke
  int before = -1;
  for (int i = 0; i <= 3600; ++i) {
    const double angle = 2 * 3.14159265358979 * (i + 0.5) / 3600;
    const int x = static_cast<int>(std::lround(200 + 180 * std::cos(angle)));
    const int y = static_cast<int>(std::lround(200 + 180 * std::sin(angle)));
    const int now = image(x, y) > 0 ? 1 : 0;
    if (before >= 0 && now != before) ++changes;
    before = now;
  }
  CHECK(changes == 72);
  const double part = static_cast<double>(lit(image)) / (401.0 * 401.0);
  CHECK(std::abs(part - 0.5) <
        0.01);  // pixels on the edges of 72 sectors, a fraction of 72 * 200 / 401^2 = 9 %, even out
}

TEST_CASE("Blinks, also every nth of them, differ from all that are shifted in half of their steps") {
  const auto projector = small_projector();
  const auto order = pattern_order({"blink"}, projector);
  CHECK(lit(pattern_frame({"blink"}, projector, 0)) == 0);
  CHECK(lit(pattern_frame({"blink"}, projector, 1)) == 64 * 48);
  REQUIRE(order.size() == 127);
  CHECK(std::count(order.begin(), order.end(), 1) == 64);
  int wrong = 0;
  for (std::size_t every = 1; every < 127; ++every) {
    for (std::size_t shift = 1; shift < 127; ++shift) {
      int differ = 0;
      for (std::size_t n = 0; n < 127; ++n) differ += order[n * every % 127] ^ order[(n * every + shift) % 127];
      wrong += differ == 64 ? 0 : 1;
    }
  }
  CHECK(wrong == 0);
  PatternPlan ramp{"ramp"};
  ramp.steps = 3;
  CHECK(pattern_order(ramp, projector) == std::vector<int>{0, 1, 2});
}

TEST_CASE("An unknown pattern is a usage error") {
  CHECK(fault_of([] { (void)pattern_frames({"gird"}, small_projector()); }) == Fault::usage);
}
