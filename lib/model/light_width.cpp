// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/light_width.hpp"

#include <algorithm>
#include <cmath>

#include "base/text/text.hpp"

namespace vam::model {

namespace {

constexpr const char* hold_name = "vam:hold_deg";
constexpr const char* half_angle_name = "vam:half_angle_deg";

double hold_deg(const Printer& printer, double step_deg) {
  if (printer.stage.motion == "stepped") return 0;
  if (printer.stage.motion == "held") return step_deg;
  constexpr double rounding = 1e-6;
  const double shown_deg = printer.stage.speed_deg_s / printer.projector.fps;
  if (std::abs(shown_deg / step_deg - 1) < rounding) return step_deg;
  // Half of the light of a frame is in each of two neighbours: twice as variable as a box.
  return std::sqrt(std::max(shown_deg * shown_deg, 2 * step_deg * step_deg) + shown_deg * shown_deg);
}

}  // namespace

LightWidth light_width(const Printer& printer, double step_deg) {
  return {hold_deg(printer, std::abs(step_deg)), printer.projector.half_angle_deg.value_or(0)};
}

void state_width(Metadata& metadata, const LightWidth& width) {
  const auto state = [&](const char* name, double value) {
    metadata.erase(name);
    if (value > 0) metadata[name] = format_number(value, 6);
  };
  state(hold_name, width.hold_deg);
  state(half_angle_name, width.half_angle_deg);
}

LightWidth stated_width(const Metadata& metadata) {
  return {stated_number(metadata, hold_name).value_or(0), stated_number(metadata, half_angle_name).value_or(0)};
}

std::string words(const LightWidth& width) {
  std::string text;
  if (width.half_angle_deg > 0) text = "light of half angle " + format_number(width.half_angle_deg, 3) + " deg";
  if (width.hold_deg > 0) {
    text += (text.empty() ? "each frame over " : ", each frame over ") + format_number(width.hold_deg, 3) +
            " deg of the stage";
  }
  return text;
}

}  // namespace vam::model
