// SPDX-License-Identifier: GPL-3.0-or-later
// Welding and orienting by CGAL's polygon soup functions: what solid::repair is held against.
#pragma once

#include "model/mesh.hpp"

namespace vam::oracle {

/// The soup with equal points and equal triangles merged and each component oriented consistently, to one side or the
/// other (CGAL::Polygon_mesh_processing::orient_polygon_soup).
model::TriangleSoup oriented_by_cgal(const model::TriangleSoup& soup);

}  // namespace vam::oracle
