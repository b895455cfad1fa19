// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of poses (CSV), and the wobble that a calibration record knows.
#pragma once

#include <optional>
#include <string>

#include "model/pose.hpp"
#include "model/printer.hpp"

namespace vam::io {

/// Reads the columns angle_deg,dx_mm,dy_mm,dz_mm,moves, one line a frame [formats: Poses]. Throws Error: no_input, io,
/// data (not such a table).
[[nodiscard]] model::Poses read_poses(const std::string& path);

/// Throws Fault::data unless there is a pose for every one of `frames` frames, or for any number of them if that is 0,
/// at stage angles start, start + step and so on.
void require_angles(const std::string& path, const model::Poses& poses, int frames, double start_deg, double step_deg);

/// How the vial's axis circles the rotation axis.
struct WobbleRecord {
  double radius_mm = 0;
  double lab_angle_deg = 0;  // direction of the vial at stage angle 0, from +x towards +y
};
/// From a record of `vam-calibrate edges`, which looks along the projector, or `axis`, which looks along the camera.
/// Throws Error: no_input, data (another file, or a record without wobble).
[[nodiscard]] WobbleRecord read_wobble(const std::string& path, const model::Printer& printer, int direction);

/// The radius of the wobble in the edges record in force, in mm, where it is more than three standard deviations; else
/// nothing. Throws what current_record() throws.
[[nodiscard]] std::optional<double> wobble_in_force_mm(const model::Calibration& calibration);

}  // namespace vam::io
