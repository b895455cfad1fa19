// SPDX-License-Identifier: GPL-3.0-or-later
// Points that are meant to be one become one; triangles that are none, or there twice, go.
#pragma once

#include <span>

#include "model/mesh.hpp"

namespace vam::solid {

/// Gives points with the same coordinates one index and removes unused points. Returns how many went.
long weld_equal_points(model::TriangleSoup& mesh);

/// Joins each of `candidates` (point indices) to an earlier candidate within `distance`, if there is one. Returns how
/// many points went. Candidates are few (border points), so the time is that of a sort.
long weld_near_points(model::TriangleSoup& mesh, std::span<const int> candidates, double distance);

/// Removes triangles that use a point twice. Returns how many went.
long drop_degenerate(model::TriangleSoup& mesh);

/// Of triangles with the same three points keeps one, with the orientation that most of them have, and further ones
/// where these balance edges, as where two overlapping solids end in one face. Where as many run
/// one way round as the other they cancel: patches of such go altogether if the other triangles are closed without
/// them. Returns how many went.
long drop_duplicates(model::TriangleSoup& mesh);

}  // namespace vam::solid
