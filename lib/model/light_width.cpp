// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/light_width.hpp"

#include <algorithm>
#include <cmath>

#include "base/text/text.hpp"

namespace vam::model {

namespace {

constexpr const char* hold_name = "vam:hold_deg";
constexpr const char* half_angle_name = "vam:half_angle_deg";
constexpr const char* across_name = "vam:half_angle_across_only";

/// Mean square of the distance of the projections from the place `at`, in steps, for which a frame of `span` shows
/// them.
double square_away(double at, double span) {
  const double below = at - std::floor(at);
  if (span <= 1) return below * (1 - below);
  double sum = 0;
  for (double k = std::round(at - 0.5 * span); k - 0.5 < at + 0.5 * span; ++k) {
    const double share = std::min(k + 0.5, at + 0.5 * span) - std::max(k - 0.5, at - 0.5 * span);
    sum += share / span * (k - at) * (k - at);
  }
  return sum;
}

double hold_deg(const Printer& printer, double step_deg) {
  if (printer.stage.motion == "stepped") return 0;
  if (printer.stage.motion == "held") return step_deg;
  return interpolated_hold_deg(printer.stage.speed_deg_s / printer.projector.fps, step_deg);
}

}  // namespace

double interpolated_hold_deg(double frame_deg, double step_deg) {
  constexpr double most = 1e5;  // frames
  const double frames = std::clamp(std::round(360 / frame_deg), 1.0, most);
  double square = 0;
  for (double n = 0; n < frames; ++n) square += square_away(n * frame_deg / step_deg, frame_deg / step_deg) / frames;
  return std::sqrt(frame_deg * frame_deg + 12 * square * step_deg * step_deg);
}

LightWidth light_width(const Printer& printer, double step_deg, bool across_only) {
  const double half_angle_deg = printer.projector.half_angle_deg.value_or(0);
  return {hold_deg(printer, std::abs(step_deg)), half_angle_deg, across_only && half_angle_deg > 0};
}

void state_width(Metadata& metadata, const LightWidth& width) {
  const auto state = [&](const char* name, double value) {
    metadata.erase(name);
    if (value > 0) metadata[name] = format_number(value, 6);
  };
  state(hold_name, width.hold_deg);
  state(half_angle_name, width.half_angle_deg);
  state(across_name, width.across_only ? 1 : 0);
}

LightWidth stated_width(const Metadata& metadata) {
  return {stated_number(metadata, hold_name).value_or(0), stated_number(metadata, half_angle_name).value_or(0),
          metadata.contains(across_name)};
}

std::string words(const LightWidth& width) {
  std::string text;
  if (width.half_angle_deg > 0) text = "light of half angle " + format_number(width.half_angle_deg, 3) + " deg";
  if (width.across_only) text += " across only";
  if (width.hold_deg > 0) {
    text += (text.empty() ? "each frame over " : ", each frame over ") + format_number(width.hold_deg, 3) +
            " deg of the stage";
  }
  return text;
}

}  // namespace vam::model
