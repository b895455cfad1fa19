// A grid's size in words.
#pragma once

#include <string>

#include "model/grid.hpp"

namespace vam::model {

/// "161 x 161 x 40 voxels", for messages.
[[nodiscard]] inline std::string size_text(const Grid& grid) {
  return std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " x " + std::to_string(grid.nz) + " voxels";
}

}  // namespace vam::model
