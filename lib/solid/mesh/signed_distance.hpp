// SPDX-License-Identifier: GPL-3.0-or-later
// A reference surface that answers "how far, and on which side?", also on a grid.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/vector3.hpp"
#include "model/grid.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

/// The foot of a point on the surface.
struct ClosestPoint {
  Vector3 point{};
  Vector3 normal{};  // of the triangle it lies on, unit length
  int triangle = 0;  // for the next call of closest()
};

/// Closest points by a tree of boxes, sides by the generalised winding number, so that a reference with holes works.
/// All calls may come from several threads.
class Surface {
 public:
  /// Degenerate triangles are left out. Throws Fault::data when none remains.
  explicit Surface(const model::TriangleSoup& mesh);
  ~Surface();

  /// `start`: ClosestPoint::triangle of a point nearby makes it faster, not different.
  [[nodiscard]] ClosestPoint closest(const Vector3& point, int start = 0) const;
  /// closest() of all points, in parallel.
  [[nodiscard]] std::vector<ClosestPoint> closest(std::span<const Vector3> points) const;
  /// mm, positive outside the surface, negative inside (MeshLab's, CloudCompare's and Open3D's sign).
  [[nodiscard]] double signed_distance(const Vector3& point) const;
  /// signed_distance of all points, in parallel.
  [[nodiscard]] std::vector<float> signed_distances(std::span<const Vector3> points) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Signed distances in mm at the voxels of the grid, positive outside, cut off at +-band_mm; x fastest, then y, then z.
/// Blocks of voxels that lie farther away are not searched voxel by voxel.
[[nodiscard]] model::Volume distance_band(const Surface& surface, const model::Grid& grid, double band_mm);

}  // namespace vam::solid
