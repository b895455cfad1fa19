// SPDX-License-Identifier: GPL-3.0-or-later
// Consistent, then outward orientation of the components of a welded mesh.
#pragma once

#include <vector>

#include "model/mesh.hpp"
#include "solid/mesh/geometry.hpp"

namespace vam::solid {

struct Orientation {
  long flipped = 0;
  long components = 0;
  long cavities = 0;
  long unorientable = 0;        // edges with two triangles that cannot agree
  std::vector<Bounds> outward;  // boxes of the components, but for those that face inwards
};

/// Orients in place; see repair().
Orientation orient(model::TriangleSoup& mesh);

}  // namespace vam::solid
