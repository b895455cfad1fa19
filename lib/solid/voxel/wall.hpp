// SPDX-License-Identifier: GPL-3.0-or-later
// How thin the walls of a part are, in voxels and in mm.
#pragma once

#include <array>
#include <optional>

#include "model/grid.hpp"

namespace vam::solid {

inline constexpr double least_printed_voxels = 3;  // thinner walls may not print

struct Walls {
  /// The thickness that one in a hundred places of the walls' middle does not exceed; where a part has no walls, as a
  /// cone, the diameter of the largest ball within; none for a part without a voxel.
  std::optional<double> thinnest_voxels;
  double thinnest_mm = 0;  // of the print: a way along z is shorter in the resin than in the stretched target
  /// The thinnest place of all that a few beside it confirm, as in a strut, or that is a neck, narrower by 2 voxels
  /// than on both sides; none where it is not thinner by more than 1.5 voxels.
  struct Place {
    double voxels = 0;
    double mm = 0;                  // of the print
    std::array<double, 3> at_mm{};  // likewise
  };
  std::optional<Place> thinnest_place;
  bool sharp_edges = false;  // one in a hundred places of the middle taper to less than what prints, and than the walls
};

/// The middle of a part is where no voxel around is farther from the void; thickness is the way from the void that is
/// nearest to the void on the other side. Faces that converge by more than 20 degrees are no walls: the edge of a wedge
/// is thin whatever the part. Voxels of at least half coverage are of the part. Good to a voxel along the axes, to two
/// across. The part is stretched along z by `stretch_z`.
[[nodiscard]] Walls walls(const model::Volume& part, double stretch_z = 1);

}  // namespace vam::solid
