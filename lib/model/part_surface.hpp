// SPDX-License-Identifier: GPL-3.0-or-later
// What a part's own surface shows and its voxels may not: walls and gaps that are thin for them, and pieces.
#pragma once

#include <array>

namespace vam::model {

/// A wall or gap as wide holds a voxel that is more than half within; below, coverage cannot tell whether it prints.
inline constexpr double thin_voxels = 1.5;
/// One at least as wide holds a voxel that is wholly within; in thinner ones the surface may cut all.
inline constexpr double narrow_voxels = 2;
/// A cavity at least as wide holds a voxel that is three quarters free; smaller ones may be lost.
inline constexpr double lost_voxels = 2.3;
/// In a bore of so many some voxel is wholly free, wherever it lies: the diagonals of two voxels' faces.
inline constexpr double free_voxels = 2.83;

/// Of one kind.
struct ThinPlaces {
  double area_mm2 = 0;            // of the faces of all below lost_voxels; 0: there are none
  double mm = 0;                  // across, of the thinnest that has two faces of a voxel; of relief the median
  std::array<double, 3> at_mm{};  // one such place, in the target's frame

  /// By more than facets take off a round wall.
  [[nodiscard]] bool are_below(double voxels, double voxel_mm) const {
    constexpr double rounding = 0.01;
    return area_mm2 > 0 && mm < (1 - rounding) * voxels * voxel_mm;
  }
};

struct PartSurface {
  ThinPlaces walls, gaps;  // between faces that are nearly parallel
  ThinPlaces blocked;      // of gaps below free_voxels those near which no voxel is wholly void
  ThinPlaces relief;       // ridges and grooves side by side, as of a knurl
  int solids = 0;          // that are apart; 0: not known
  int specks = 0;          // of these, so small that they may not count in a print
};

/// Seen by voxels of some size.
struct VoxelisedSurface {
  PartSurface places;
  double voxel_mm = 1;
  [[nodiscard]] bool has_thin_walls() const { return places.walls.are_below(thin_voxels, voxel_mm); }
  [[nodiscard]] bool has_thin_gaps() const {
    return places.gaps.are_below(thin_voxels, voxel_mm) || places.blocked.area_mm2 > 0;
  }
  /// Of which has_thin_gaps() tells.
  [[nodiscard]] const ThinPlaces& thin_gaps() const {
    return places.blocked.area_mm2 > 0 ? places.blocked : places.gaps;
  }
  [[nodiscard]] bool may_lose_walls() const { return places.walls.are_below(lost_voxels, voxel_mm) || has_relief(); }
  [[nodiscard]] bool may_lose_gaps() const { return places.gaps.are_below(lost_voxels, voxel_mm) || has_relief(); }
  [[nodiscard]] bool has_relief() const { return places.relief.are_below(thin_voxels, voxel_mm); }
  [[nodiscard]] bool leaves_doubt() const { return has_thin_walls() || has_thin_gaps() || has_relief(); }
};

}  // namespace vam::model
