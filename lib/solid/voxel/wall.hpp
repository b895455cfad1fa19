// SPDX-License-Identifier: GPL-3.0-or-later
// How thin the walls of a part are, in voxels.
#pragma once

#include <optional>

#include "model/grid.hpp"

namespace vam::solid {

/// The thickness in voxels that one in a hundred places of the part's middle does not exceed. Its middle is where no
/// voxel around is farther from the void; thickness is the way from the void that is nearest to the void on the other
/// side. Voxels of at least half coverage are of the part. Good to a voxel along the axes, to two across; none for a
/// part without a voxel.
[[nodiscard]] std::optional<double> thinnest_wall_voxels(const model::Volume& part);

}  // namespace vam::solid
