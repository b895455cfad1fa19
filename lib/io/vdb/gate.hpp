// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that the values of a grid are valid for its name before anything is computed from them.
#pragma once

#include <string>
#include <vector>

#include "io/vdb/vdb.hpp"

namespace vam::io {

/// What a target may be: coverage of the part, 0 to 1, or with --grey-target a dose or response for every voxel, 0 and
/// more.
enum class TargetKind { coverage, grey };

/// Throws Fault::data with file, voxel and remedy: two grids of one name, a level set named target or insert, a
/// background of these other than 0, a size that is none in mm (below 0.1 mm or above 2 m), a value outside what the
/// grid can have: target and insert 0 to 1, a grey target 0 to 1e9 (to 1e-4), weight, tolerance and dose 0 to 1e9.
/// Grids of other names may be anything. `path` begins the message, "-" is stdin.
void check_values(const std::string& path, const std::vector<SparseVolume>& volumes,
                  TargetKind target = TargetKind::coverage);
void check_values(const std::string& path, const SparseVolume& volume, TargetKind target = TargetKind::coverage);

}  // namespace vam::io
