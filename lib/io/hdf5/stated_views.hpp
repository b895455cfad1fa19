// SPDX-License-Identifier: GPL-3.0-or-later
// What a file of projections, or of a volume, states about them.
#pragma once

#include <string>
#include <vector>

namespace vam::io {

struct StatedViews {
  bool top_first = false;          // the file has its rows from the top; they are read upwards
  std::string source;              // of the angles, a dataset
  std::vector<double> angles_deg;  // of the rows of a sinogram, as measured; none where the file has none
  double voxel_mm = 0;             // the edge of a volume's voxels; 0: not stated
};

}  // namespace vam::io
