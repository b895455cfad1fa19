// SPDX-License-Identifier: GPL-3.0-or-later
// The print as a body of one density.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "metrology/ost/private/back_projection.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// The volume of sinograms (of the grid's slices, columns x angles over a turn) as bodies of one density, the median of
/// what is above half of the 99th percentile. Bubbles that were not removed leave streaks in it, and fainter places in
/// bodies: values from a quarter to three quarters of the density are stretched to 0 to 1 of it, so that edges, at
/// half, stay where they are. A place that is seen through, by rays below `dark`, is empty: a bubble is there in few
/// views.
[[nodiscard]] model::Volume one_density_body(const ClimbingRays& rays, const model::Grid& grid,
                                             const std::vector<Image>& sinograms, float dark);

}  // namespace vam::metrology
