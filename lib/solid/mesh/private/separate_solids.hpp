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

 private:
  mutable std::optional<WindingNumber> winding_;
};

/// Solids of a repaired mesh that are apart: no edge of one crosses the other, neither holds the other, and they are no
/// nearer than `near_mm` where a sample of the surface shows it. Smaller ones than `least_mm3` are specks.
class SeparateSolids {
 public:
  SeparateSolids(const SurfaceTree& surface, const Repair& repaired, const std::vector<SurfaceSample>& samples,
                 double near_mm, double least_mm3);
  /// 0: they cannot be told, as the mesh is not closed.
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int specks() const { return specks_; }
  /// Whether two triangles are of one surface, or of surfaces that touch, as far as that can be told.
  [[nodiscard]] bool are_one(int triangle, int other) const {
    return solid_.empty() || solid_[mesh_.triangles[triangle][0]] == solid_[mesh_.triangles[other][0]];
  }

 private:
  void find(const SurfaceTree& surface, const Bounds& shared, const std::vector<SurfaceSample>& samples, double near_mm,
            double least_mm3);

  const model::TriangleSoup& mesh_;
  std::vector<int> solid_;  // of each point; empty: all are one, or cannot be told
  int count_ = 0, specks_ = 0;
};

}  // namespace vam::solid
