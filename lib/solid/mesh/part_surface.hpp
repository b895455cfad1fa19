// SPDX-License-Identifier: GPL-3.0-or-later
// Where faces of a part's surface are close: walls between faces that look away from each other, gaps between faces
// that look at each other; and in how many pieces the part is.
#pragma once

#include "model/grid.hpp"
#include "model/mesh.hpp"
#include "model/part_surface.hpp"
#include "solid/mesh/repair.hpp"

namespace vam::solid {

/// Separate solids, and walls and gaps of a repaired mesh that are thin for the voxels of a grid, by rays along the
/// normals from points spread over the surface: about one for each face of a voxel, 200000 at most. Faces
/// that would meet within six voxels, or four times their distance, as at the edge of a wedge or where a ball stands on
/// a plate, are none unless they are of surfaces that do not touch; nor are faces of overlapping solids within each
/// other. Relief is where ridges and grooves of less than 80 degrees and thin_voxels are within a few voxels of each
/// other.
[[nodiscard]] model::PartSurface part_surface(const model::TriangleSoup& mesh, const Repair& repaired,
                                              const model::Grid& grid);

}  // namespace vam::solid
