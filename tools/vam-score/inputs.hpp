// SPDX-License-Identifier: GPL-3.0-or-later
// The dose and its target.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "io/vdb/vdb.hpp"
#include "vam-score/options.hpp"

namespace vam::score_tool {

struct Inputs {
  std::vector<io::SparseVolume> volumes;
  std::size_t dose_at = 0;
  std::size_t target_at = 0;
  std::optional<std::size_t> band_at;  // of each voxel of a grey target; none: it is the same for all
  [[nodiscard]] const io::SparseVolume& dose() const { return volumes[dose_at]; }
  [[nodiscard]] const io::SparseVolume& target() const { return volumes[target_at]; }
  [[nodiscard]] const io::SparseVolume* band() const { return band_at ? &volumes[*band_at] : nullptr; }
};

/// Throws Fault::data when a grid is missing, or when the two are not of the same voxels.
[[nodiscard]] Inputs read(const Options& options);

}  // namespace vam::score_tool
