// SPDX-License-Identifier: GPL-3.0-or-later
// A volume at half of its resolution.
#pragma once

#include "io/vdb/vdb.hpp"

namespace vam::io {

/// The means of 2 x 2 x 2 voxels, on model::coarser(grid); beyond the finer grid there is the background. Name, units,
/// history and other metadata are the finer volume's.
[[nodiscard]] SparseVolume coarser(const SparseVolume& volume);

}  // namespace vam::io
