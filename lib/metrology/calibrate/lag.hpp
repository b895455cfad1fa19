// SPDX-License-Identifier: GPL-3.0-or-later
// Lag of a camera's time stamps: a bead on the stage appears at an angle too large by speed times lag in both
// directions of rotation, whereas its own phase changes sign [physics §10].
#pragma once

#include <vector>

#include "base/stats/measured.hpp"
#include "metrology/calibrate/axis.hpp"

namespace vam::metrology {

/// Degrees a second of the straight line through the angles; at least two different times. Throws Fault::data.
[[nodiscard]] double turning_speed_deg_s(const std::vector<double>& time_s, const std::vector<double>& angle_deg);

/// Sensitivity of a circle's phase to an error of each frame's angle: frames at which the bead moves sideways count.
/// The sum is 1.
[[nodiscard]] std::vector<double> phase_weights(const std::vector<double>& angle_deg, double phase_deg);

/// Milliseconds by which the time stamps of both turns are late; negative: early. A bead furthest towards high columns
/// at the stage's own angle phi is so at the reported angles phi + speed * lag and, backwards, -phi + speed * lag, as
/// reported angles increase either way. Speeds in deg/s, above 0. Throws Fault::data when a speed is not, or the phase
/// of a turn is not known within 10 degrees.
[[nodiscard]] stats::Measured camera_lag_ms(const CameraAxis& forwards, double forwards_deg_s,
                                            const CameraAxis& backwards, double backwards_deg_s);

}  // namespace vam::metrology
