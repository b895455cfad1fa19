// SPDX-License-Identifier: GPL-3.0-or-later
// What a part's own surface shows and its voxels may not: walls and gaps that are thin for them, and pieces.
#pragma once

#include <array>

namespace vam::model {

/// Thinner ones need not have a voxel that is wholly within.
inline constexpr double thin_voxels = 1.5;

/// Of one kind.
struct ThinPlaces {
  double area_mm2 = 0;            // of their faces; 0: there are none
  double mm = 0;                  // across; a tenth of the area is no farther apart, of relief half of it
  std::array<double, 3> at_mm{};  // one such place, in the target's frame

  /// Whether voxels leave them in doubt. A tip or a speck is less.
  [[nodiscard]] bool matter(double voxel_mm) const {
    constexpr double least_area = 2;  // faces of a voxel
    return area_mm2 >= least_area * voxel_mm * voxel_mm && mm < thin_voxels * voxel_mm;
  }
};

struct PartSurface {
  ThinPlaces walls, gaps;  // between faces that are all but parallel
  ThinPlaces relief;       // ridges and grooves side by side, as of a knurl
  int solids = 0;          // that are apart; 0: not known
};

/// Seen by voxels of some size.
struct VoxelisedSurface {
  PartSurface places;
  double voxel_mm = 1;
  [[nodiscard]] bool has_walls() const { return places.walls.matter(voxel_mm); }
  [[nodiscard]] bool has_gaps() const { return places.gaps.matter(voxel_mm); }
  [[nodiscard]] bool has_relief() const { return places.relief.matter(voxel_mm); }
  [[nodiscard]] bool has_any() const { return has_walls() || has_gaps() || has_relief(); }
};

}  // namespace vam::model
