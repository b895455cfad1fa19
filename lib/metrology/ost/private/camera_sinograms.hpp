// SPDX-License-Identifier: GPL-3.0-or-later
// Views of a turn, row by row, to what one height shows at every angle.
#pragma once

#include <span>
#include <vector>

#include "metrology/ost/private/angle_grid.hpp"
#include "metrology/ost/private/heights.hpp"
#include "metrology/ost/views.hpp"

namespace vam::metrology {

/// Each view at the heights of `rows`: camera columns x heights, the axis upright.
[[nodiscard]] std::vector<Image> level_views(std::span<const CameraView> views, const LevelRows& rows);

/// Takes an even background out of each view, then divides what is left by its relative intensity; an empty span means
/// steady light.
void make_steady(std::vector<Image>& level, double background, std::span<const double> intensity);

/// How the vial's place moves the columns of one view: what is at column x for a vial in its place is seen at
/// x + shift + stretch (x - axis column).
struct ColumnMotion {
  double shift_px = 0;
  double stretch = 0;

  [[nodiscard]] double at(double from_axis_px) const { return shift_px + stretch * from_axis_px; }
};

/// Undoes the motion of each view (cubic [KEYS81]); beyond the image its last column. Nothing where there is none.
void undo_motion(std::vector<Image>& level, std::span<const ColumnMotion> motion, double axis_column);

/// Sinograms in camera columns x even angles, one for each row of the level views: of three turns or more their median,
/// so that what passes in less than half of them does not count.
[[nodiscard]] std::vector<Image> camera_sinograms(std::span<const Image> level, const Turns& turns);

}  // namespace vam::metrology
