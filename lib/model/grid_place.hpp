// SPDX-License-Identifier: GPL-3.0-or-later
// Where the voxels of a grid are among those of another.
#pragma once

#include <array>
#include <optional>

#include "model/grid.hpp"

namespace vam::model {

/// The voxel (i, j, k) of `whole` at which the first of `part` is. None unless every voxel of `part` is one of `whole`:
/// to a thousandth of a voxel, as files round.
[[nodiscard]] std::optional<std::array<int, 3>> place_in(const Grid& whole, const Grid& part);

/// Both have the same voxels.
[[nodiscard]] bool same_voxels(const Grid& grid, const Grid& other);

}  // namespace vam::model
