// SPDX-License-Identifier: GPL-3.0-or-later
// The grids of a job's files: target, what stands beside it, doses. All values are checked.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "model/value_at.hpp"

namespace vam::session {

/// All grids of a file. Throws as io::read_volumes(), and unless they are only looked at, without a kind of the target,
/// as io::check_values().
[[nodiscard]] std::vector<io::SparseVolume> read_grids(const std::string& path, std::optional<io::TargetKind> kind);
/// The first of that name; null: none.
template <class Grids>
[[nodiscard]] auto* find_grid(Grids& grids, const std::string& name) {
  const auto found = std::find_if(grids.begin(), grids.end(), [&](const auto& grid) { return grid.name() == name; });
  return found == grids.end() ? nullptr : &*found;
}
/// Those of a file that places a dose or light: its target is grey where it states a unit, else coverage.
[[nodiscard]] std::vector<io::SparseVolume> read_like(const std::string& path);
/// The target, or else the first.
[[nodiscard]] io::SparseVolume& target_or_first(std::vector<io::SparseVolume>& grids);
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

/// A volume, and what stands beside it in its file, or in that of the part where one is named.
class Companions {
 public:
  /// part: empty: all is in one file. Throws as read_grids().
  Companions(const std::string& path, const std::string& part, std::optional<io::TargetKind> kind);

  /// The volume of that name, or the only one when it is empty. Throws as io::choose_volume().
  io::SparseVolume& choose(const std::string& name);
  [[nodiscard]] bool has(const std::string& name) const { return find_grid(own_, name) != nullptr; }
  [[nodiscard]] const io::SparseVolume& volume() const { return *volume_; }
  [[nodiscard]] const std::string& file() const { return part_.empty() ? path_ : part_; }  // of the part

  /// Throws Fault::data where there is none.
  [[nodiscard]] io::SparseVolume& target();
  /// The same on the grid of the volume, with void around. Throws as SparseVolume::extend_to(), too.
  [[nodiscard]] io::SparseVolume& target_around();
  /// On the grid of the volume; null: there is none, or it is the volume.
  [[nodiscard]] const io::SparseVolume* insert();
  /// Of a grey target; null: there is none.
  [[nodiscard]] const io::SparseVolume* tolerance() { return find_grid(beside(), "tolerance"); }

 private:
  [[nodiscard]] std::vector<io::SparseVolume>& beside() { return part_.empty() ? own_ : others_; }

  std::string path_, part_;
  std::vector<io::SparseVolume> own_, others_;
  io::SparseVolume* volume_ = nullptr;
};

/// Slices k to k + count - 1 of a larger grid of the same voxels, `outside` around those of the volume. Throws
/// Fault::data where it does not hold that of the volume, as it must where both are of one target.
void read_around(const io::SparseVolume& volume, const model::Grid& grid, float outside, int k, int count, float* to);
/// Of a grid that must lie on that of the target. file: begins the message.
[[nodiscard]] Error differs_from_target(const io::SparseVolume& volume, const std::string& file);

/// Warns of part voxels of the file that no ray reaches beside the insert, if there are any.
void warn_of_shadowed_voxels(const std::string& path, std::int64_t voxels);

}  // namespace vam::session
