// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/stray_cure.hpp"

#include "base/text/json.hpp"

namespace vam::model {

VoxelBox covered_box(const Volume& volume, float above) {
  const Grid& grid = volume.grid;
  VoxelBox box{{grid.nx, grid.ny, grid.nz}, {-1, -1, -1}};
  const float* value = volume.values.data();
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        if (*value++ <= above) continue;
        box.low = {std::min(box.low[0], i), std::min(box.low[1], j), std::min(box.low[2], k)};
        box.high = {std::max(box.high[0], i), std::max(box.high[1], j), std::max(box.high[2], k)};
      }
    }
  }
  return box;
}

void append_json(Json& report, const StrayCure& outside) {
  report["outside_voxels"] = outside.voxels;
  report["outside_gelled_voxels"] = outside.gelled_voxels;
  report["outside_max_dose"] = outside.max_dose;
}

}  // namespace vam::model
