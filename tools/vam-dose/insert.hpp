// SPDX-License-Identifier: GPL-3.0-or-later
// The opaque object that a dose is simulated around.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/vdb/vdb.hpp"
#include "light/simulation/simulation.hpp"
#include "model/stack.hpp"

namespace vam::dose_tool {

/// The grid 'insert' of a file, if there is one, slice by slice, and what of the part lies in its shadow from all
/// sides.
class Insert {
 public:
  /// Null volumes: no insert, no part; else those of the dose's voxels.
  Insert(const io::SparseVolume* insert, const io::SparseVolume* target, const model::Grid& grid,
         const model::StackInfo& light);

  [[nodiscard]] bool there() const { return insert_ != nullptr; }

  /// Coverage of slices [first, first + count); nothing if none of them has an opaque voxel.
  [[nodiscard]] std::vector<Image> slices(int first, int count) const;

  /// Counts the voxels of the part that even light leaves dark in the slices from `first` on with these inserts.
  void look_for_dark(const light::Simulation& simulation, int first, std::span<const Image> inserts);
  [[nodiscard]] std::int64_t dark_part_voxels() const { return dark_; }

 private:
  const io::SparseVolume* insert_;
  const io::SparseVolume* target_;
  int nx_, ny_;
  Image even_;    // one slice of light
  int rows_ = 0;  // of light
  std::int64_t dark_ = 0;
};

}  // namespace vam::dose_tool
