// SPDX-License-Identifier: GPL-3.0-or-later
// The holes of an open surface.
#pragma once

#include "model/mesh.hpp"

namespace vam::solid {

/// Closes the surface by triangles from each edge of a border to the mean of that border's edges: an even hole gets a
/// flat lid. Equal points are welded first. Every edge has an even number of triangles then, which may cross others,
/// and whose orientation means nothing. Returns how many edges were open.
long close_holes(model::TriangleSoup& mesh);

}  // namespace vam::solid
