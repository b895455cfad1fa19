// SPDX-License-Identifier: GPL-3.0-or-later
// The grids of a job's files: target, what stands beside it, doses. All values are checked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "model/value_at.hpp"

namespace vam::session {

/// All grids of a file. Throws as io::read_volumes() and io::require_usable().
[[nodiscard]] std::vector<io::SparseVolume> read_grids(const std::string& path, io::TargetKind kind);
/// The first of that name; null: none.
[[nodiscard]] io::SparseVolume* find_grid(std::vector<io::SparseVolume>& grids, const std::string& name);
/// The same of the grids of `file`. Throws Fault::data, which `remedy` ends, where it is missing.
[[nodiscard]] io::SparseVolume& require_grid(std::vector<io::SparseVolume>& grids, const std::string& name,
                                             const std::string& file, const std::string& remedy);
/// One of them, which they lose.
[[nodiscard]] io::SparseVolume taken(std::vector<io::SparseVolume>& grids, io::SparseVolume& grid);

/// A grid in a file of its own: the one of that name, or the only one. Throws Fault::data where there is none.
[[nodiscard]] io::SparseVolume read_grid(const std::string& path, const std::string& name);
/// Coverage of the part: the grid 'target', or the only one. Throws as read_grid().
[[nodiscard]] model::StretchedVolume read_target(const std::string& path);
/// The grid 'dose'. Throws Fault::data where it is not in mJ/cm3.
[[nodiscard]] io::SparseVolume read_dose(const std::string& path);
/// The grid 'scatter' of vam-ost. Throws Fault::data where it is in mJ/cm3: a dose of that name.
[[nodiscard]] io::SparseVolume read_scatter(const std::string& path);

/// A copy on a larger grid of the same voxels, with `outside` around. Throws Fault::data, a message that `file` begins,
/// where that does not hold its grid, as it must where both are of one target.
[[nodiscard]] io::SparseVolume widened(const io::SparseVolume& volume, const model::Grid& grid, float outside,
                                       const std::string& file);
/// Of a grid that must lie on that of the target. file: begins the message.
[[nodiscard]] Error differs_from_target(const io::SparseVolume& volume, const std::string& file);

/// Warns of part voxels of the file that no ray reaches beside the insert, if there are any.
void warn_of_shadowed_voxels(const std::string& path, std::int64_t voxels);

}  // namespace vam::session
