// SPDX-License-Identifier: GPL-3.0-or-later
// A grid's size and place in words.
#pragma once

#include <string>

#include "base/text/text.hpp"
#include "model/grid.hpp"

namespace vam::model {

/// "161 x 161 x 40 voxels", for messages.
[[nodiscard]] inline std::string size_text(const Grid& grid) {
  return std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " x " + std::to_string(grid.nz) + " voxels";
}

/// "161 x 161 x 40 voxels of 0.2 mm from (-16, -16, 0.1)", the centre of the first, for messages.
[[nodiscard]] inline std::string place_text(const Grid& grid) {
  const auto& first = grid.origin_mm;
  return size_text(grid) + " of " + format_number(grid.voxel_mm) + " mm from (" + format_number(first[0]) + ", " +
         format_number(first[1]) + ", " + format_number(first[2]) + ")";
}

}  // namespace vam::model
