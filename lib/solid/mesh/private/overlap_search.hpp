// SPDX-License-Identifier: GPL-3.0-or-later
// Private to align: where a part of a print may lie on the design when moments say nothing.
#pragma once

#include <vector>

#include "solid/mesh/geometry.hpp"
#include "solid/mesh/private/align_starts.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::solid {

/// The `count` best of all poses on a grid of rotations and shifts that keep the points within the design's box, by
/// the mean distance of 48 of them to the design, distances cut off at a twentieth of its size; each rotation once.
[[nodiscard]] std::vector<Motion> overlapping_poses(const std::vector<Eigen::Vector3d>& print, const Bounds& box,
                                                    const Surface& design, std::size_t count);

}  // namespace vam::solid
