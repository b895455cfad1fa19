// SPDX-License-Identifier: GPL-3.0-or-later
// The same bench at half of the resolution: every pixel and voxel is two of the finer ones in each direction.
#pragma once

#include "model/grid.hpp"
#include "model/printer.hpp"

namespace vam::model {

/// Voxel (i, j, k) covers voxels 2 i and 2 i + 1, 2 j and 2 j + 1, 2 k and 2 k + 1; the last ones may reach beyond.
[[nodiscard]] Grid coarser(const Grid& grid);

/// Column c covers columns 2 c and 2 c + 1, row r rows 2 r and 2 r + 1; the lens stays where it is.
[[nodiscard]] Printer coarser(const Printer& printer);

}  // namespace vam::model
