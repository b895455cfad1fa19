// SPDX-License-Identifier: GPL-3.0-or-later
// How wide light is: a lens has an aperture, and the stage turns while a frame is shown [physics §4].
#pragma once

#include <string>

#include "model/metadata.hpp"
#include "model/printer.hpp"

namespace vam::model {

struct LightWidth {
  double hold_deg = 0;        // edge of the box with the variance of the stage angles at which a frame is shown
  double half_angle_deg = 0;  // of the round cone of light of a pixel, in air
  bool across_only = false;   // that cone is neglected along z

  bool operator==(const LightWidth&) const = default;
};

/// Of projections that are `step_deg` apart.
[[nodiscard]] LightWidth light_width(const Printer& printer, double step_deg, bool across_only = false);

/// The same for projections of which a video, or a screen, shows frames that are `frame_deg` apart.
[[nodiscard]] double interpolated_hold_deg(double frame_deg, double step_deg);

/// States it; a width of 0 is not.
void state_width(Metadata& metadata, const LightWidth& width);
[[nodiscard]] LightWidth stated_width(const Metadata& metadata);

/// E.g. "light of half angle 0.64 deg, each frame over 3 deg of the stage"; empty for none.
[[nodiscard]] std::string words(const LightWidth& width);

}  // namespace vam::model
