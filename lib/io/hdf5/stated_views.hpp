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
  std::vector<double> voxel_mm;    // of a volume, along the file's axes, the fastest first; none where it has none
};

}  // namespace vam::io
