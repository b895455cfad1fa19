// SPDX-License-Identifier: GPL-3.0-or-later
// Which slices decide the exposure that all slices share.
#pragma once

#include <functional>
#include <span>

#include "base/text/json_fwd.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// Array of at most three: the slice with the brightest pixel, which determines the duration at full grey; the one with
/// the least part dose, below which the threshold must lie; the one with the largest void dose, above which it must. Of
/// equal slices the lowest. Each {what, z_mm, value, median, why}: `value` beside the median of the slices that have
/// one. height_mm(k): of slice k in the print.
[[nodiscard]] Json limited_by(std::span<const SliceDemand> demands, const std::function<double(int k)>& height_mm);

}  // namespace vam::optimize
