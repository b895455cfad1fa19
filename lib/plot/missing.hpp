// SPDX-License-Identifier: GPL-3.0-or-later
// What of a part is missing in its print, with what voxels that the surface cuts hold of it.
#pragma once

#include <array>
#include <vector>

#include "io/vdb/vdb.hpp"
#include "plot/planes.hpp"

namespace vam::plot {

struct MissingPart {
  io::SparseVolume shares;                   // of each voxel: the part's coverage of it where it is missing
  std::array<std::vector<double>, 3> along;  // its sums over the voxels with one i, j and k

  /// The section in which much is missing, half as much as in any or more: the one nearest to the middle; the middle
  /// one where nothing is missing.
  [[nodiscard]] int section(Plane plane) const;
};

/// Counted as missing are, where they are below the threshold, voxels wholly inside the part and those of walls that no
/// voxel nearby is half covered by [verdict::lost_walls], and those at which a wall is cut or missing
/// [verdict::defect_voxels]. Both volumes have the same grid.
[[nodiscard]] MissingPart missing_part(const io::SparseVolume& dose, const io::SparseVolume& target, double threshold);

/// 1 in voxels of walls that no voxel nearby is half covered by, with a dose only in those below the threshold.
[[nodiscard]] io::SparseVolume lost_wall_volume(const io::SparseVolume& target, const io::SparseVolume* dose,
                                                double threshold);

}  // namespace vam::plot
