// SPDX-License-Identifier: GPL-3.0-or-later
// The doses of a pass, added to the totals of the run.
#pragma once

#include <span>

#include "model/outside.hpp"
#include "model/piece.hpp"
#include "optimize/run/private/ledger.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/pass.hpp"

namespace vam::optimize {

/// Where the jobs of a run lie in its volume.
struct Jobs {
  const model::VoxelBox& part;       // its box
  std::span<const int> of_slice;     // as in Schedule
  model::ImageRange asked;           // slices that count
  std::span<const int> slices_each;  // of them, that a job stands for
};

/// Of the pass's own jobs: what they print and, unless the target is grey, what they leave outside the part's box.
void tally(std::span<const Slab> dose, const Problem& problem, const Pass& pass, const Jobs& jobs, Ledger& ledger);

}  // namespace vam::optimize
