// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a target is grey: a dose for every voxel, and not coverage, which is between 0 and 1 at surfaces only.
#pragma once

#include <functional>

#include "model/grid.hpp"

namespace vam::model {

/// Of the voxels above 0 the share that is between 0 and 1 and no surface: a plane that cuts a voxel leaves one of its
/// 26 neighbours wholly on either side. `read` gives slice k, row-major; voxels beyond the grid are 0.
[[nodiscard]] double grey_share(const Grid& grid, const std::function<void(int k, float* out)>& read);

/// A share from which on it is worth a warning; walls and gaps of one voxel have some, too.
inline constexpr double least_grey_share = 0.05;

}  // namespace vam::model
