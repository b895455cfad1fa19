// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of a wobbling vial and of a helical print [physics §11].
#pragma once

#include "model/grid.hpp"
#include "model/pose.hpp"
#include "model/printer.hpp"

namespace vam::light {

/// A vial whose axis circles the rotation axis: at stage angle theta it stands at radius_mm in the direction
/// lab_angle_deg - direction * theta of the laboratory, from +x towards +y [physics §11]. One turn.
[[nodiscard]] model::Poses wobble_poses(double radius_mm, double lab_angle_deg, int direction, int angles);

/// A part taller than the image, lifted by pitch_mm a turn (lowered, if negative): the whole grid passes all rows, in
/// as many whole turns as that takes, midway in their middle. Every slice is in the image for the image's height
/// over the pitch, in turns. Throws Fault::usage when that is less than half a turn.
[[nodiscard]] model::Poses helix_poses(const model::Printer& printer, const model::Grid& grid, double pitch_mm,
                                       int angles);

/// Whether the vial may stand so far beside the axis: beyond the writable radius rays are known in its place only.
[[nodiscard]] bool may_move(const model::Printer& printer, double judged_mm, double by_mm);
/// Throws Fault::data where poses displace the vial and it may not move.
void require_in_reach(const model::Poses& poses, const model::Printer& printer, double judged_mm);

}  // namespace vam::light
