// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles in a tree of boxes, which closest points and winding numbers walk. The generalised winding number of a
// triangle soup, also of one with holes: 1 inside, 0 outside, in between near a hole, so that "more than a half" is the
// best answer to "inside?" [JKS13]. Far triangles are summed as dipoles of a tree, with the next order [BAR18; physics
// §13.2].
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/vector3.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/geometry.hpp"

namespace vam::solid {

using TriangleCorners = std::array<Vector3, 3>;

[[nodiscard]] inline TriangleCorners corners(const model::TriangleSoup& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

/// The normal, of which the length is twice the area.
[[nodiscard]] inline Vector3 twice_area(const TriangleCorners& c) { return cross(c[1] - c[0], c[2] - c[0]); }

/// work(i, start) for i below `count`, in parallel by chunks; `start` is what the call before left, at first 0: the
/// triangle next to a point, as neighbours in a list are mostly neighbours in space.
template <class Work>
void for_chunks(std::size_t count, const Work& work, std::size_t chunk = 1024) {
  parallel_for(static_cast<int>((count + chunk - 1) / chunk), [&](int c) {
    int start = 0;
    for (std::size_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) work(i, start);
  });
}

/// A node holds triangles [begin, end); an inner one has children at index + 1 and at `right`, so children follow their
/// parent and the root is node 0.
struct TriangleNode {
  Bounds box;
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

class WindingNumber {
 public:
  /// The mesh must be oriented (repair orients).
  explicit WindingNumber(const model::TriangleSoup& mesh);
  /// Shares a tree that is there.
  explicit WindingNumber(std::shared_ptr<const TriangleTree> tree);

  /// In 4 pi steradians, positive inside an outward-oriented surface. Absolute error below 0.05, which "more than a
  /// half" does not feel.
  [[nodiscard]] double operator()(const Vector3& point) const;

 private:
  struct Cluster {                    // what a node looks like from far
    Vector3 centre{};                 // area-weighted centroid
    Vector3 area{};                   // sum of the triangles' area vectors: the dipole moment
    std::array<Vector3, 3> second{};  // sum of (centroid - centre) x area vector, outer product: the next order
    double weight = 0;                // sum of the areas
    double reach = 0;                 // beyond this distance the summary will do
  };
  [[nodiscard]] Cluster of_leaf(const TriangleNode& node) const;
  [[nodiscard]] Cluster merged(const Cluster& a, const Cluster& b) const;
  [[nodiscard]] double solid_angle(std::size_t node, const Vector3& point) const;

  std::shared_ptr<const TriangleTree> tree_;
  std::vector<Cluster> clusters_;  // one a node
};

}  // namespace vam::solid
