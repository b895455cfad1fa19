// SPDX-License-Identifier: GPL-3.0-or-later
// Fractional coverage of voxels by a mesh, exact where the mesh is closed [physics §13.1].
#pragma once

#include <functional>

#include "model/grid.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/geometry.hpp"

namespace vam::solid {

enum class Fill {
  exact,  // divergence theorem along x; for a closed, outward-oriented mesh
  vote,   // the same along x, y and z, and the median of what they say; for a mesh with holes
};

/// Receives slices k0 .. k0 + count - 1, coverage 0...1, x fastest, then y, in ascending order.
using SliceSink = std::function<void(int k0, int count, const float* slices)>;

inline constexpr int slab = 16;  // slices handed on at a time

struct Vote {
  long inside = 0;     // voxels covered by more than a half
  long undecided = 0;  // voxels about which the axes disagree; they take their neighbours' mean
};

/// Coverage of the voxels of `grid` by the mesh, which must lie within it in x and y. Every triangle is cut to voxels.
/// A piece with outward vector area (Ax, Ay, Az) in voxel faces removes Ax from all voxels of its row further along x,
/// and the share of Ax behind it from its own: the divergence theorem for the field (x, 0, 0). Prefix sums along the
/// row give the coverage, which for a closed mesh is the winding number averaged over the voxel; its magnitude is cut
/// off at 1. Solids may overlap: voxels that they share in part are covered by their union, summed along rays
/// (unite_row), in all rows of the box `shared` (Repair::shared) and in those that have a mean winding number above 1.
///
/// With Fill::vote each axis gives an interval: the sums from either end of the row, which agree unless the row runs
/// through a hole. The median of the six ends is the coverage; undecided are voxels where the two middle ones are more
/// than a half apart.
///
/// Memory: the mesh, its bins (4 bytes a triangle and slice), 16 slices. Same bytes for any number of threads.
/// Throws Fault::bug when the mesh leaves the grid in x or y.
Vote voxelize(const model::TriangleSoup& mesh, const model::Grid& grid, Fill fill, const Bounds& shared,
              const SliceSink& sink);

}  // namespace vam::solid
