// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the two projectors is quicker.
#pragma once

#include <cstddef>

#include "tomo/fourier_radon.hpp"
#include "tomo/radon.hpp"

namespace vam::tomo {

/// Time in ns of A and A* together on one thread, as measured on one machine; ratios are what it is for.
struct RadonCost {
  double footprints = 0;
  double fourier = 0;
};

/// For so many slabs a call, or for one slice. The geometry has no alpha_per_px.
[[nodiscard]] RadonCost radon_cost(const ParallelGeometry& geometry, std::size_t slabs,
                                   FourierRadon::Slices slices = FourierRadon::Slices::all);

}  // namespace vam::tomo
