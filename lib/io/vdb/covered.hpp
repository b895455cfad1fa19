// SPDX-License-Identifier: GPL-3.0-or-later
// Where a volume has values.
#pragma once

#include "io/vdb/vdb.hpp"
#include "model/dose/outside.hpp"

namespace vam::io {

/// The smallest box of the volume's grid that holds all voxels whose value is above that.
[[nodiscard]] model::VoxelBox covered_box(const SparseVolume& volume, float above);

}  // namespace vam::io
