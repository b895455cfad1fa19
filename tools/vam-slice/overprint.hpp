// SPDX-License-Identifier: GPL-3.0-or-later
// A part and the insert it is printed around.
#pragma once

#include "base/text/json_fwd.hpp"
#include "io/vdb/vdb.hpp"
#include "solid/voxel/part.hpp"
#include "vam-slice/options.hpp"

namespace vam::slice_tool {

/// Is the insert below or above all slices of the volume? Then says so.
[[nodiscard]] bool is_beyond(const solid::Part& placed, const model::Grid& grid, double stretch_z);

/// The part, without the insert with --cut-insert. The volume must outlive what is returned.
[[nodiscard]] solid::Part around(const solid::Part& part, const io::SparseVolume& insert, const Options& options);

/// For --report. Warns of an insert that misses or overlaps the part.
[[nodiscard]] Json insert_figures(const io::SparseVolume& target, const io::SparseVolume& insert,
                                  const solid::Part& placed, const Options& options);

}  // namespace vam::slice_tool
