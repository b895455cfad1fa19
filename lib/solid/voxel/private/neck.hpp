// SPDX-License-Identifier: GPL-3.0-or-later
// Necks: where a part is narrower than on both sides, as an hourglass is, none of whose faces is near a parallel one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vam::solid {

/// squared: of each voxel, x fastest, its squared distance to the nearest void voxel, in voxels; 0 of void, which the
/// outermost layer is. Returns voxels of at most `most`: in each, as voxels are added from the deepest on, two sets
/// come to touch (by a corner at least) that both have a voxel deeper than it by `least_deeper`.
[[nodiscard]] std::vector<std::int64_t> necks(const std::array<int, 3>& size, const std::vector<std::int32_t>& squared,
                                              std::int32_t most, double least_deeper);

}  // namespace vam::solid
