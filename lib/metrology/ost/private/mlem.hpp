// SPDX-License-Identifier: GPL-3.0-or-later
// Statistical refinement of a reconstruction, for noisy views.
#pragma once

#include <span>

#include "base/compute/slab.hpp"
#include "tomo/radon.hpp"

namespace vam::metrology {

/// MLEM: x <- x * A*(g / A x) / A* 1 [SV82]; keeps x >= 0 and the counts. `images` holds the start, and x afterwards.
void maximise_likelihood(const tomo::ParallelGeometry& geometry, std::span<const Slab> sinograms, int iterations,
                         std::span<Slab> images);

}  // namespace vam::metrology
