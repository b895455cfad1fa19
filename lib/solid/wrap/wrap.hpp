// SPDX-License-Identifier: GPL-3.0-or-later
// A closed surface around a mesh of any state; and what is left of a mesh without another one.
#pragma once

#include <string>

#include "model/mesh.hpp"

namespace vam::solid {

struct WrapSize {
  double alpha_mm = 0;   // > 0; openings narrower than twice that are closed
  double offset_mm = 0;  // > 0; from the mesh to the vertices of the wrap, which lies wholly outside the mesh
};

struct Wrap {
  model::TriangleSoup mesh;  // closed, without crossings; triangles run anticlockwise seen from outside
  long open_edges = 0;       // that the mesh had
};

/// CGAL's 3D alpha wrap [PRH22] of the mesh with lids on its holes narrower than 2 alpha (close_holes): cracks,
/// crossings, doubled and inner surfaces do not matter; cavities are filled. Where it gets in by a wider hole, so that
/// it has 1.2 times the mesh's area, all holes get lids: one between two borders may lie across a hole of the part.
/// Takes 0.1 to 0.2 ms and up to 2 kB a triangle, of which there are some 2.1 area / alpha^2. Throws Fault::data beyond
/// two million of these, Fault::memory for a lack of memory.
[[nodiscard]] Wrap wrapped(const model::TriangleSoup& mesh, const WrapSize& size, const std::string& subject);

/// `mesh` without what `taken_away` encloses, by the curves in which they cross: exact but for the rounding of these.
/// Of a mesh that crosses itself each connected body is cut, so that what is left may overlap as before. Throws
/// Fault::data where one is not closed, or a body crosses itself.
[[nodiscard]] model::TriangleSoup difference(model::TriangleSoup mesh, model::TriangleSoup taken_away,
                                             const std::string& subject);

}  // namespace vam::solid
