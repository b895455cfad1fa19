// SPDX-License-Identifier: GPL-3.0-or-later
// Projector, vial and grid of one chief-ray dose.
#pragma once

#include "model/grid.hpp"
#include "model/pose.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optics/resample_stack.hpp"

namespace vam::light {

/// Row a of a sinogram is at stage angle turn.start + a * turn.step; the part stands at direction * stage angle +
/// offset. Slice k is at height z_scale * grid.z_mm(k) in the resin, z_scale = M_vp: the target was stretched by
/// 1 / M_vp when sliced, so that on the axis slice k is lit by row k [physics §2].
struct VialSetup {
  optics::View view;
  optics::Detector projector;
  optics::Turn turn;
  int direction = 1;
  double angle_offset_rad = 0;
  double absorption_per_mm = 0;
  double hold_rad = 0;             // the stage turns by it while a frame is shown
  double half_angle_rad = 0;       // of the round bundle of a pixel, in air; seen along the rotation axis
  double rows_half_angle_rad = 0;  // the same, seen from the side: rows then light the slices beside their own
  double focus_mm = 0;             // of the image in air, behind the axis
  model::Grid grid;
  double radius_mm = 0;     // voxels farther from the axis get no light; 0: the resin's radius
  double z_scale = 1;       // M_vp
  int rows = 0;             // rows of light; 0: one a slice, as many as slabs hold
  double first_row_mm = 0;  // z_p of row 0, from the lens's axis up; rows follow in voxel_mm
  double lowest_mm = -1e9;  // z_p of the projector's rows: what lies beyond stays dark where rays climb
  double highest_mm = 1e9;
  model::Poses
      poses;  // one a row of the turn, which may then be any number of turns; none: the vial stands in its place

  /// Where the part stands at that row of the turn.
  [[nodiscard]] double part_angle_rad(int row) const {
    return direction * (turn.start_rad + row * turn.step_rad) + angle_offset_rad;
  }
};

/// Light that is to be made: `angles` rows from stage angle 0, a row of light for every slice.
[[nodiscard]] VialSetup vial_setup(const model::Printer& printer, const model::Grid& grid, int angles,
                                   double radius_mm);

/// The poses of the frames, and the rows that light these slices in any of them, as far as the projector has them; rows
/// stand where slices do. Without poses nothing changes. Throws Fault::data when no row does.
void place_rows(VialSetup& setup, const model::Poses& poses, const model::Grid& slices);

/// Moves the poses of a turn's frames, or none, so that the vial's axis is off the rotation axis, where it is at stage
/// angle 0, and the part sinks evenly while they are shown.
void displace(VialSetup& setup, double vial_x_mm, double vial_y_mm, double sinking_mm);

/// Light that a projector's stack holds: its rows, angles and poses. Throws Fault::data unless its columns are the
/// printer's and its slices the grid's.
[[nodiscard]] VialSetup vial_setup(const model::Printer& printer, const optics::AxisAlignment& alignment,
                                   const model::StackInfo& info, const model::Grid& grid);

/// Width of the box of stage angles over which a frame of projections that are so far apart is shown.
[[nodiscard]] double hold_rad(const model::Printer& printer, double step_rad);

/// The setup with numbers for what 0 stands for. Throws Fault::data unless the rows are one turn.
[[nodiscard]] VialSetup completed(VialSetup setup);

/// Throws Fault::data unless so many angles cover 360 degrees.
void require_one_turn(int angles, double step_deg);

}  // namespace vam::light
