// SPDX-License-Identifier: GPL-3.0-or-later
// An angle of the stage at a time, as a line of text: what vam-stage writes, and what the player, the cameras and
// vam-calibrate read. It needs no device.
#pragma once

#include <string>

namespace vam::device {

/// An angle at a time with its standard deviation: one line of vam-stage's output.
struct AngleSample {
  double t_s = 0;  // CLOCK_MONOTONIC
  double angle_deg = 0;
  double sigma_deg = 0;
  bool ramp = false;  // the stage has not yet reached its speed
};

/// {"t_monotonic_s":12.3456789,"angle_deg":45.12345,"sigma_deg":0.00123}, with "ramp":true on the ramp; the first of a
/// series with its schema.
[[nodiscard]] std::string to_line(const AngleSample& sample, bool first = false);
/// Throws Fault::data for anything else: "stage angles: line 7: ...".
[[nodiscard]] AngleSample parse_angle_line(const std::string& line, long number);

}  // namespace vam::device
