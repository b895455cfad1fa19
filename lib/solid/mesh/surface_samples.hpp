// SPDX-License-Identifier: GPL-3.0-or-later
// Points that stand for a surface.
#pragma once

#include <vector>

#include "base/vector3.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

/// A point spread evenly over a surface, and the unit normal of its triangle.
struct SurfaceSample {
  Vector3 point;
  Vector3 normal;
  int triangle = 0;  // of the mesh
};

/// About `count` points, each standing for the same area (vertices would overweight fine triangles): stratified along
/// the running area, with a seeded position inside the triangle; the same points for the same mesh and count.
[[nodiscard]] std::vector<SurfaceSample> sample_surface(const model::TriangleSoup& mesh, int count);

}  // namespace vam::solid
