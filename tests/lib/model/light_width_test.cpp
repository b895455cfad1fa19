// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/light_width.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace vam::model;

TEST_CASE("a frame is as wide as the stage angles at which its light is shown") {
  Printer printer;
  printer.projector.fps = 16;
  printer.stage.speed_deg_s = 10;
  const auto hold = [&](const char* motion, double step_deg) {
    printer.stage.motion = motion;
    return light_width(printer, step_deg).hold_deg;
  };
  CHECK(hold("stepped", 1) == 0);
  CHECK(hold("held", -3) == 3);
  CHECK(hold("interpolated", 0.625) == 0.625);  // each frame of the video is one of the stack
  // The angles at which some light of a frame is on, in a video of 576 frames a turn: counted. Where frames of the
  // stack are k of the video apart, w^2 = s^2 + 2 D^2 (1 - 1 / k^2).
  for (const double step : {1.0, 3.0, 0.25, 1.25, 0.625, 0.62500001, 0.3125, 0.5}) {
    CAPTURE(step);
    double sum = 0, square = 0;
    for (int n = 0; n < 576; ++n) {
      const double between = 0.625 * n / step, later = between - std::floor(between);
      for (int part = 0; part < 40 * 240; ++part) {
        const double stage = 0.625 * (n + (part / 240 + 0.5) / 40 - 0.5);
        const double within = (part % 240 + 0.5) / 240;  // the mean of what the frame spans, or two neighbours
        const double shown = step < 0.625 ? std::round(0.625 * (n + within - 0.5) / step)
                                          : std::floor(between) + (within < later ? 1 : 0);
        const double away = stage - step * shown;
        sum += 1, square += away * away;
      }
    }
    CHECK(hold("interpolated", step) == doctest::Approx(std::sqrt(12 * square / sum)).epsilon(2e-3));
  }
  CHECK(hold("interpolated", 1.25) == doctest::Approx(std::sqrt(0.625 * 0.625 + 2 * 1.25 * 1.25 * 3 / 4)));
}

TEST_CASE("the width of light is stated where there is some, and read again") {
  Metadata metadata{{"vam:hold_deg", "3"}, {"vam:half_angle_deg", "1"}};
  CHECK(stated_width(metadata) == LightWidth{3, 1});
  state_width(metadata, {0, 0.64});
  CHECK(metadata == Metadata{{"vam:half_angle_deg", "0.64"}});
  CHECK(words(stated_width(metadata)) == "light of half angle 0.64 deg");
  CHECK(words({1, 0.64}) == "light of half angle 0.64 deg, each frame over 1 deg of the stage");
  CHECK(words({}).empty());
  Printer printer;
  CHECK(light_width(printer, 1, true) == LightWidth{1, 0});
  printer.stage.motion = "stepped";
  printer.projector.half_angle_deg = 0.64;
  state_width(metadata, light_width(printer, 1, true));
  CHECK(words(stated_width(metadata)) == "light of half angle 0.64 deg across only");
}
