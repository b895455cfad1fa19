// SPDX-License-Identifier: GPL-3.0-or-later
// What of a target its voxels are too coarse for: walls and gaps of which no voxel nearby is wholly part, or wholly
// void.
#pragma once

#include "model/grid.hpp"

namespace vam::optimize {

/// In voxels of volume.
struct Unresolved {
  double part = 0;   // of the part, in voxels without one wholly inside the part among their 26 neighbours
  double gaps = 0;   // of the void, in voxels without one wholly outside
  double whole = 0;  // of the part, all of it
  int slice = 0;     // the one with most of it
  int first = 0;     // slices [first, end) are those from the first to the last with a tenth as much or more
  int end = 0;
  [[nodiscard]] double share() const { return whole > 0 ? (part + gaps) / whole : 0; }
};

/// Of a coverage 0...1. Voxels beyond the grid are void.
[[nodiscard]] Unresolved unresolved(const model::Volume& target);

}  // namespace vam::optimize
