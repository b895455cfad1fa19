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
  // The angles at which some light of a frame is on, in a video of 576 frames a turn: counted.
  for (const double step : {1.0, 3.0, 0.25}) {
    double sum = 0, square = 0;
    for (int n = 0; n < 576; ++n) {
      for (int part = 0; part < 100; ++part) {
        const double at = 0.625 * (n + (part + 0.5) / 100 - 0.5);  // of the stage, shown is what belongs to 0.625 n
        const double between = 0.625 * n / step;
        if (step < 0.625) {  // the mean of what the frame spans
          const double from = 0.625 * (n - 0.5), away = at - from;
          sum += 1, square += away * away - 0.625 * away + 0.625 * 0.625 / 3;
          continue;
        }
        const double later = between - std::floor(between);
        const double first = at - step * std::floor(between), second = first - step;
        sum += 1, square += (1 - later) * first * first + later * second * second;
      }
    }
    CHECK(hold("interpolated", step) == doctest::Approx(std::sqrt(12 * square / sum)).epsilon(0.02));
  }
}

TEST_CASE("the width of light is stated where there is some, and read again") {
  Metadata metadata{{"vam:hold_deg", "3"}, {"vam:half_angle_deg", "1"}};
  CHECK(stated_width(metadata) == LightWidth{3, 1});
  state_width(metadata, {0, 0.64});
  CHECK(metadata == Metadata{{"vam:half_angle_deg", "0.64"}});
  CHECK(words(stated_width(metadata)) == "light of half angle 0.64 deg");
  CHECK(words({1, 0.64}) == "light of half angle 0.64 deg, each frame over 1 deg of the stage");
  CHECK(words({}).empty());
}
