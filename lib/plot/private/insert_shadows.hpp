// SPDX-License-Identifier: GPL-3.0-or-later
// An opaque insert in the sections of a volume, and the shadow it throws.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "io/vdb/vdb.hpp"
#include "plot/planes.hpp"

namespace vam::plot {

struct InsertSection {
  Image coverage;  // of the insert, as the sections of planes()
  Image shadow;    // fraction [0, 1] of the stage angles from which the insert hides a voxel, for parallel light that
                   // stays level; 0 in the insert
};

/// Sections at these indices, in their order, row 0 at the top. Angles are sampled every 7.5 degrees.
[[nodiscard]] std::vector<InsertSection> insert_sections(const io::SparseVolume& insert, Plane plane,
                                                         const std::vector<int>& indices);

}  // namespace vam::plot
