// SPDX-License-Identifier: GPL-3.0-or-later
// Closed cavities in words and figures, in mm of the print, which `stretch_z` stretches the part of.
#pragma once

#include <string>

#include "base/text/json_fwd.hpp"
#include "verdict/cavities.hpp"

namespace vam::solid {

/// "1 closed cavity of 12 mm3 at x, y, z = 0, 0, 5 mm, from which resin cannot drain"; empty if there is none.
[[nodiscard]] std::string trapped_resin(const verdict::Cavities& cavities, double voxel_mm, double stretch_z);

/// cavities, volume_mm3, largest_mm3, at_mm; null if there is none.
[[nodiscard]] Json trapped_resin_figures(const verdict::Cavities& cavities, double voxel_mm, double stretch_z);

}  // namespace vam::solid
