// SPDX-License-Identifier: GPL-3.0-or-later
// The same job at half of the resolution.
#pragma once

#include "vam-optimize/inputs.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// On voxels of twice the size (io::coarser).
[[nodiscard]] Inputs coarser(const Inputs& in);

/// With half of the angles and bins, and without whatever is made of the result alone.
[[nodiscard]] Options coarser(const Options& options);

}  // namespace vam::optimize_tool
