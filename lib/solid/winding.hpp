// The generalised winding number of a triangle soup, also of one with holes: 1 inside, 0 outside, in between near a
// hole, so that "more than a half" is the best answer to "inside?" (Jacobson et al., SIGGRAPH 2013). Far triangles are
// summed as dipoles of a tree, with the next order (Barill et al., "Fast winding numbers for soups and clouds",
// SIGGRAPH 2018).
#pragma once

#include <vector>

#include "base/vector3.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

class WindingNumber {
 public:
  /// The mesh must be oriented (repair orients); it is copied as far as needed.
  explicit WindingNumber(const model::TriangleSoup& mesh);

  /// In 4 pi steradians, positive inside an outward-oriented surface. Absolute error below 0.05, which "more than a
  /// half" does not feel.
  [[nodiscard]] double operator()(const Vector3& point) const;

 private:
  struct Node {
    Vector3 centre{};                 // area-weighted centroid
    Vector3 area{};                   // sum of the triangles' area vectors: the dipole moment
    std::array<Vector3, 3> second{};  // sum of (centroid - centre) x area vector, outer product: the next order
    double radius = 0;                // of the ball about centre that holds the triangles
    int begin = 0;
    int end = 0;    // triangles of a leaf
    int left = -1;  // children; -1 in a leaf
    int right = -1;
  };
  int build(int begin, int end, std::vector<std::array<Vector3, 3>>& triangles);
  void summarise(Node& node) const;
  [[nodiscard]] double solid_angle(int node, const Vector3& point) const;

  std::vector<std::array<Vector3, 3>> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace vam::solid
