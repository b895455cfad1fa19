// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh in voxel units, sorted into layers; the moments of its pieces; rows of sums. Shared by voxelize and its vote.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/buckets.hpp"
#include "base/vector3.hpp"
#include "model/grid.hpp"
#include "model/mesh.hpp"
#include "solid/voxel/private/clip.hpp"
#include "solid/voxel/voxelize.hpp"

namespace vam::solid {

using TriangleCorners = std::array<Vector3, 3>;

/// Triangles in voxel units: voxel (i, j, k) spans i ... i + 1 and so on. What lies below or above the grid is cut off.
/// Throws Fault::bug when one leaves the grid in x or y.
[[nodiscard]] std::vector<TriangleCorners> in_voxels(const model::TriangleSoup& mesh, const model::Grid& grid);

[[nodiscard]] Polygon polygon(const TriangleCorners& corners);

/// For every layer along one axis the triangles that meet it, in ascending order.
[[nodiscard]] Buckets<int> by_layer(const std::vector<TriangleCorners>& triangles, std::size_t axis, int layers);

/// Of a piece: the component of its vector area along an axis, and that times its mean coordinate.
struct Moment {
  double area = 0;
  double first = 0;
};
[[nodiscard]] Moment moment(const Polygon& piece, std::size_t axis);

/// The share of a piece's area that its own voxel `index` takes; the voxels behind take all of it.
[[nodiscard]] inline double own_share(const Moment& m, int index) { return (index + 1) * m.area - m.first; }

/// Coverage 0 ... 1 of the voxels of `grid`, each triangle's corners in voxels from the grid's corner and in any
/// orientation that the mesh has consistently; slices go to the sink in ascending order. Returns how many voxels are
/// inside and about how many the axes disagree (Fill::vote). Throws Fault::bug when a corner lies outside in x or y.
Vote vote(const std::vector<TriangleCorners>& triangles, const model::Grid& grid, const SliceSink& sink);

/// Rows of a slice, each with one entry more than it has voxels. Only touched rows are cleared.
class VoxelRows {
 public:
  void reset(int rows, int voxels);
  [[nodiscard]] bool touched(int row) const { return touched_[row] != 0; }
  /// Entries of a row, cleared when first needed.
  double* operator[](int row);
  /// Enters a piece: its voxel by its share, the next by the rest; the prefix sum carries that on.
  static void enter(double* row, int index, const Moment& m) {
    const double own = own_share(m, index);
    row[index] -= own;
    row[index + 1] -= m.area - own;
  }
  /// Prefix sums of a row in place; returns the total, 0 when every ray that enters also leaves.
  double accumulate(int row);

 private:
  int length_ = 0;
  std::vector<double> values_;
  std::vector<char> touched_;
};

/// A winding number averaged over a voxel to coverage. Residues of cancelling sums stay below 1e-9 of a voxel for a
/// million triangles, and a true coverage within 1e-6 of 0 or 1 makes no difference to a dose: both are snapped, so
/// that void and interior are exact.
[[nodiscard]] inline float settled(double winding) {
  const double coverage = std::abs(winding);
  if (coverage < 1e-6) return 0;
  if (coverage > 1 - 1e-6) return 1;
  return static_cast<float>(coverage);
}

}  // namespace vam::solid
