// SPDX-License-Identifier: GPL-3.0-or-later
// The dose and its target.
#pragma once

#include <vector>

#include "io/vdb/vdb.hpp"
#include "vam-score/options.hpp"

namespace vam::score_tool {

struct Inputs {
  std::vector<io::SparseVolume> of_target, of_dose, of_band;  // the grids of each file
  const io::SparseVolume* dose = nullptr;
  const io::SparseVolume* target = nullptr;  // on the grid of the dose
  const io::SparseVolume* band = nullptr;    // of each voxel of a grey target; null: it is the same for all
};

/// Throws Fault::data when a grid is missing, or when the two are not of the same voxels.
[[nodiscard]] Inputs read(const Options& options);

}  // namespace vam::score_tool
