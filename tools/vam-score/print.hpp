// SPDX-License-Identifier: GPL-3.0-or-later
// What prints, as a mesh or as points.
#pragma once

#include "io/vdb/vdb.hpp"
#include "vam-score/options.hpp"

namespace vam::score_tool {

/// To --mesh. Throws Fault::data when nothing prints at this dose.
void write_print(const Options& options, const io::SparseVolume& dose, double threshold);

}  // namespace vam::score_tool
