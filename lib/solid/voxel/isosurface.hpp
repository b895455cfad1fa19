// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of what prints: where a volume crosses a threshold.
#pragma once

#include <functional>

#include "model/grid.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

/// Copies `count` row-major slices of the volume from k on, one after the other; called from one thread.
using ReadSlices = std::function<void(int k, int count, float* out)>;

/// Closed mesh in mm around { value >= level }, facets anticlockwise seen from outside, by dual contouring of the
/// trilinear field (openvdb volumeToMesh): vertices lie within a fraction of a voxel of the crossing. Beyond the grid
/// the value is taken as below the level, so that a surface closes at its border.
/// Memory: the volume and its mesh. Empty when nothing reaches the level.
/// Throws Fault::data for a value that is not finite, Fault::usage for a level that is not.
[[nodiscard]] model::TriangleSoup isosurface(const model::Grid& grid, const ReadSlices& read, double level);
[[nodiscard]] model::TriangleSoup isosurface(const model::Volume& volume, double level);

/// The same, of voxels half as large, which the field is interpolated on, unless that would be more than a million
/// triangles or so: where one voxel holds several of the surface's sheets, as around rods and gaps of two voxels, one
/// vertex cannot follow them.
[[nodiscard]] model::TriangleSoup fine_isosurface(const model::Grid& grid, const ReadSlices& read, double level);
[[nodiscard]] model::TriangleSoup fine_isosurface(const model::Volume& volume, double level);

/// Centres in mm of the voxels with value >= level, and their values: the print as a point cloud [CAL17 fig 8].
struct PrintedPoints {
  model::TriangleSoup points;  // without triangles
  model::VertexData values;    // quality = value
};
[[nodiscard]] PrintedPoints printed_points(const model::Grid& grid, const ReadSlices& read, double level);

}  // namespace vam::solid
