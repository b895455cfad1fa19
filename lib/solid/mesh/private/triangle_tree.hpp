// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles in a tree of boxes: what closest points and winding numbers walk.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/vector3.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

using TriangleCorners = std::array<Vector3, 3>;

[[nodiscard]] inline TriangleCorners corners(const model::TriangleSoup& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

/// The normal, of which the length is twice the area.
[[nodiscard]] inline Vector3 twice_area(const TriangleCorners& c) { return cross(c[1] - c[0], c[2] - c[0]); }

/// A node holds triangles [begin, end); an inner one has children at index + 1 and at `right`, so children follow their
/// parent and the root is node 0.
struct TriangleNode {
  Vector3 low{};
  Vector3 high{};
  int begin = 0;
  int end = 0;
  int right = 0;  // 0 in a leaf
};

/// The triangle of the tree that is nearest, and the point on it.
struct Nearest {
  Vector3 point{};
  double distance2 = 0;
  int triangle = 0;  // in the order of the tree
};

/// Where a ray meets a triangle of the tree.
struct Hit {
  double distance = 0;
  int triangle = 0;  // in the order of the tree
};

struct TriangleTree {
  std::vector<TriangleCorners> triangles;  // in the order of the leaves
  std::vector<TriangleNode> nodes;
  std::vector<int> order;  // their places in the soup

  TriangleTree() = default;
  /// Splits at the median of the longest side of the centroids' box.
  explicit TriangleTree(std::vector<TriangleCorners> soup);

  /// Triangle 'start' is tested first: a neighbour's answer saves half of the way. There must be a triangle.
  [[nodiscard]] Nearest nearest(const Vector3& point, int start = 0) const;
  /// The first triangle that a short ray meets, least to most from its origin, of those that count, or of all. `along`
  /// has length 1. There must be a triangle.
  [[nodiscard]] std::optional<Hit> first_hit(const Vector3& from, const Vector3& along, double least, double most,
                                             const std::function<bool(int triangle)>& counts = {}) const;
  /// Whether a triangle has a point in the cube around that centre.
  [[nodiscard]] bool meets_cube(const Vector3& centre, double half_side) const;
};

/// The corners of all triangles of a mesh that have an area; their places in the mesh, where wanted.
[[nodiscard]] std::vector<TriangleCorners> corners_of(const model::TriangleSoup& mesh,
                                                      std::vector<int>* places = nullptr);

/// The nearest point of a triangle that has an area [ERI05 section 5.1.5].
[[nodiscard]] Vector3 nearest_on(const TriangleCorners& triangle, const Vector3& point);

}  // namespace vam::solid
