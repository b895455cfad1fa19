// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of voxels in which solids overlap. The mean winding number of a voxel does not tell its union: twice covered in
// one half is once covered all over.
#pragma once

#include <vector>

#include "solid/voxel/private/clip.hpp"

namespace vam::solid {

/// Puts the coverage by the union into those voxels of a row that overlapping solids cover in part, and leaves the
/// others. `strips`: the triangles of a closed mesh cut to the row (j, k); `line`: the coverage of its voxels. Along x
/// exact; along y and z at 16 to 32 places between the corners of the strips, and exact for faces along the axes.
void unite_row(const std::vector<Polygon>& strips, int j, int k, int voxels, float* line);

}  // namespace vam::solid
