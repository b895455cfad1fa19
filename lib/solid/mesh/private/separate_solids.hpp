// SPDX-License-Identifier: GPL-3.0-or-later
// In how many pieces a part is, by its own surface.
#pragma once

#include <memory>
#include <vector>

#include "model/mesh.hpp"
#include "solid/mesh/private/triangle_tree.hpp"
#include "solid/mesh/repair.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::solid {

/// A mesh, the tree of its triangles that have an area, and where in the mesh each of these is.
struct SurfaceTree {
  const model::TriangleSoup& mesh;
  std::vector<int> places;
  std::shared_ptr<const TriangleTree> tree;

  explicit SurfaceTree(const model::TriangleSoup& soup)
      : mesh(soup), tree(std::make_shared<const TriangleTree>(corners_of(soup, &places))) {}
};

/// Solids of a repaired mesh that are apart: they neither cross nor hold each other, and are no nearer than `near_mm`
/// where a sample of the surface shows it. 0 where that cannot be told: the mesh is not closed, or one of them is
/// smaller than `least_mm3`.
[[nodiscard]] int separate_solids(const SurfaceTree& surface, const Repair& repaired,
                                  const std::vector<SurfaceSample>& samples, double near_mm, double least_mm3);

}  // namespace vam::solid
