// SPDX-License-Identifier: GPL-3.0-or-later
// The generalised winding number of a triangle soup, also of one with holes: 1 inside, 0 outside, in between near a
// hole, so that "more than a half" is the best answer to "inside?" [JKS13]. Far triangles are summed as dipoles of a
// tree, with the next order [BAR18; physics §13.2].
#pragma once

#include <memory>
#include <vector>

#include "base/vector3.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/private/triangle_tree.hpp"

namespace vam::solid {

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
