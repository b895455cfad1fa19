// SPDX-License-Identifier: GPL-3.0-or-later
// Room within a part that is closed on all sides, whose resin cannot drain.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "model/grid.hpp"

namespace vam::verdict {

struct Cavities {
  int count = 0;
  std::int64_t voxels = 0;        // of all
  std::int64_t largest = 0;       // voxels of it
  std::array<double, 3> at_mm{};  // the middle of its longest row along x
};

/// Voxels that are covered by less than a half, joined by faces, that no way leads out of; at least 8 of them. Where
/// walls have no voxel that is half covered a cavity is not closed. Slice by slice, from the lowest up. Memory: the
/// runs of two slices.
class CavityFinder {
 public:
  explicit CavityFinder(const model::Grid& grid);
  ~CavityFinder();
  /// The next slices of coverage 0...1, row-major, on all threads.
  void add(int count, const float* slices);
  /// In the volume, beyond which all is free. After the last slice.
  [[nodiscard]] Cavities found() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::verdict
