// SPDX-License-Identifier: GPL-3.0-or-later
// A target that is a dose for every voxel is not taken for coverage in silence.
#pragma once

#include <string>

#include "base/log.hpp"
#include "base/text.hpp"
#include "io/stream/input_name.hpp"
#include "io/vdb/vdb.hpp"
#include "model/grey_share.hpp"

namespace vam::tool {

/// Of a target that is to be taken as coverage.
inline void warn_of_grey(const io::SparseVolume& target, const std::string& path) {
  const double share = model::grey_share(target.grid(), [&](int k, float* out) { target.read_slices(k, 1, out); });
  if (share < model::least_grey_share) return;
  warn(io::input_name(path) +
       ": the target is grey, or its voxels are too coarse for it: " + format_number(100 * share, 2) +
       " % of its voxels above 0 are between 0 and 1 and no surface, and are taken for surface that nothing is asked "
       "of; --grey-target takes the target as the dose of every voxel");
}

}  // namespace vam::tool
