// SPDX-License-Identifier: GPL-3.0-or-later
// In how many pieces a part is, by its own surface.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "model/mesh.hpp"
#include "solid/mesh/private/triangle_tree.hpp"
#include "solid/mesh/repair.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::solid {

/// A mesh, and the tree of its triangles that have an area.
struct SurfaceTree {
  const model::TriangleSoup& mesh;
  std::vector<int> places;  // in the mesh, of what the tree was made of
  std::shared_ptr<const TriangleTree> tree;

  explicit SurfaceTree(const model::TriangleSoup& soup)
      : mesh(soup), tree(std::make_shared<const TriangleTree>(corners_of(soup, &places))) {}
  /// Made when first needed, by one thread.
  [[nodiscard]] const WindingNumber& winding() const {
    if (!winding_) winding_.emplace(tree);
    return *winding_;
  }
  /// In the mesh, of a triangle of the tree.
  [[nodiscard]] int place(int triangle) const { return places[tree->order[triangle]]; }
  /// A point of a triangle of the mesh.
  [[nodiscard]] int point_of(int triangle) const { return mesh.triangles[triangle][0]; }

 private:
  mutable std::optional<WindingNumber> winding_;
};

struct SeparateSolids {
  int count = 0;  // 0: they cannot be told, as the mesh is not closed
  int specks = 0;
  std::vector<int> of_points;  // of the mesh; empty: all are one, or cannot be told

  /// Whether two points are of one surface, or of surfaces that touch, as far as that can be told.
  [[nodiscard]] bool are_one(int point, int other) const {
    return of_points.empty() || of_points[point] == of_points[other];
  }
};

/// Solids of a repaired mesh that are apart: no edge of one crosses the other, neither holds the other, and they are no
/// nearer than `near_mm` where a sample of the surface shows it. Smaller ones than `least_mm3` are specks.
[[nodiscard]] SeparateSolids separate_solids(const SurfaceTree& surface, const Repair& repaired,
                                             const std::vector<SurfaceSample>& samples, double near_mm,
                                             double least_mm3);

}  // namespace vam::solid
