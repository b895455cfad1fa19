// SPDX-License-Identifier: GPL-3.0-or-later
// The shadow that an opaque insert throws in the sections of a volume.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "io/vdb/vdb.hpp"
#include "plot/planes.hpp"

namespace vam::plot {

/// Of the sections of planes(): the fraction [0, 1] of the stage angles from which the insert hides a voxel, for
/// parallel light that stays level; 0 in the insert. Angles are sampled every 7.5 degrees.
[[nodiscard]] std::vector<Image> insert_shadows(const io::SparseVolume& insert, Plane plane,
                                                const std::vector<int>& indices);

}  // namespace vam::plot
