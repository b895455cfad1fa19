// SPDX-License-Identifier: GPL-3.0-or-later
// Where faces of a part's surface are close: walls between faces that look away from each other, gaps between faces
// that look at each other; and in how many pieces the part is.
#pragma once

#include "model/mesh.hpp"
#include "model/part_surface.hpp"
#include "solid/mesh/repair.hpp"

namespace vam::solid {

/// Separate solids, and walls and gaps of a repaired mesh that are thinner than thin_voxels of `voxel_mm`, by rays
/// along the normals from points spread over the surface: about one for each face of a voxel, 200000 at most. Faces
/// that converge by more than 28 degrees, as at the edge of a wedge, and those of overlapping solids within each other
/// are none. Relief is where ridges and grooves of less than 80 degrees are within a few voxels of each other.
[[nodiscard]] model::PartSurface part_surface(const model::TriangleSoup& mesh, const Repair& repaired, double voxel_mm);

}  // namespace vam::solid
