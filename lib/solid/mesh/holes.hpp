// SPDX-License-Identifier: GPL-3.0-or-later
// The holes of an open surface.
#pragma once

#include <limits>

#include "model/mesh.hpp"

namespace vam::solid {

/// Closes holes no wider than that by triangles from each edge of a border to the mean of that border's edges: an even
/// hole gets a flat lid. Equal points are welded first. Every edge of these has an even number of triangles then, which
/// may cross others, and whose orientation means nothing. Returns how many edges were open in all.
long close_holes(model::TriangleSoup& mesh, double widest_mm = std::numeric_limits<double>::infinity());

}  // namespace vam::solid
