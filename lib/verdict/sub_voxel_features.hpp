// SPDX-License-Identifier: GPL-3.0-or-later
// Features of a part that are too fine for its voxels: no voxel nearby is wholly part, or wholly void, and none shows
// whether they print. Walls without a half covered voxel are surely missing in the print; gaps without a voxel that is
// more than three quarters free are surely shut.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "model/grid.hpp"
#include "model/part_surface.hpp"

namespace vam::verdict {

/// Coverage of voxels that are covered by less than a half, and so are their 26 neighbours.
struct LostWalls {
  double voxels = 0;  // sum of coverage
  float most = 0;     // the largest one, about the thickness of the wall in voxels
  int first = 0;      // slices [first, end) hold them
  int end = 0;
  double far = 0;  // of the sum, what has no half covered voxel within three: rods, hairs, not sharp edges
};

/// Free shares of voxels that are free by three quarters or less, and so are their 26 neighbours. Shares below 1/64,
/// as of shells that nearly touch, are no gap, and beyond the grid all is free.
struct LostGaps {
  double voxels = 0;  // sum of free shares
  float widest = 0;   // gap, in voxels: the free shares along the axis that it is narrowest along
  int first = 0;      // slices [first, end) hold them
  int end = 0;
};

/// In voxels of volume. Voxels beyond the grid are void.
struct SubVoxelFeatures {
  double part = 0;   // of the part, in voxels without one wholly inside the part among their 26 neighbours
  double gaps = 0;   // of the void, in voxels without one wholly outside
  double whole = 0;  // of the part, all of it
  int slice = 0;     // the one with most of it
  int first = 0;     // slices [first, end) are those from the first to the last with a tenth as much or more
  int end = 0;
  LostWalls lost_walls;
  LostGaps lost_gaps;
  std::optional<model::VoxelisedSurface> surface;  // none: the surface of the part is not known

  /// Relative to the part.
  [[nodiscard]] double part_share() const { return whole > 0 ? part / whole : 0; }
  [[nodiscard]] double gap_share() const { return whole > 0 ? gaps / whole : 0; }
  [[nodiscard]] double share() const { return part_share() + gap_share(); }
  [[nodiscard]] double lost_share() const { return whole > 0 ? lost_walls.voxels / whole : 0; }

  /// Rounded edges and tips are less of a part.
  [[nodiscard]] bool is_much() const { return share() > 0.02; }
  /// A verdict on the voxels is none on the part: of its surface, or where that is not known of its voxels.
  [[nodiscard]] bool leaves_doubt() const { return is_most() || (surface ? surface->leaves_doubt() : is_much()); }
  /// Whatever the surface shows: hardly anything of the part is judged.
  [[nodiscard]] bool is_most() const { return part_share() > 0.5; }
  /// Walls will be missing in the print: more than crumbs, and where the part's surface is known more than its
  /// roughness.
  [[nodiscard]] bool loses_walls() const {
    return (loses_much() || loses_rods()) && (!surface || surface->may_lose_walls());
  }
  [[nodiscard]] bool loses_much() const { return lost_share() > 1e-3; }
  /// More than the feather edges of a large part, as where a sheet is cut at a small angle.
  [[nodiscard]] bool loses_rods() const { return lost_walls.far > std::max(2.0, 1e-6 * whole); }
  /// "walls of 0.9 voxels and gaps of 0.4 voxels", or ridges and grooves where there are neither: what the part's own
  /// surface shows to be thin, and is not known to be lost. Empty: nothing.
  [[nodiscard]] std::string thin_places() const;
  /// Gaps will be shut in the print: more than tips of grooves and corners between struts.
  [[nodiscard]] bool bridges_gaps() const;
};

/// Finds it slice by slice, from the lowest up.
class SubVoxelFinder {
 public:
  explicit SubVoxelFinder(const model::Grid& grid) : SubVoxelFinder(grid.nx, grid.ny) {}
  SubVoxelFinder(int width, int height) : width_(width), height_(height) {}
  /// The next slices of coverage 0...1, row-major.
  void add(int count, const float* slices);
  /// Of the slices so far, beyond which is nothing.
  [[nodiscard]] SubVoxelFeatures found() const;

 private:
  struct Slice {
    double part = 0, gaps = 0, whole = 0;
    LostWalls walls;
    LostGaps lost;
  };

  static constexpr int reach = 3;  // slices below and above one that it is judged by

  [[nodiscard]] Slice of_slice(const float* const* slices) const;
  [[nodiscard]] std::vector<Slice> judged(const std::vector<const float*>& slices) const;
  [[nodiscard]] std::vector<const float*> open() const;

  int width_, height_;
  std::vector<float> kept_;    // the last slices
  std::vector<Slice> slices_;  // all but the last ones
  int added_ = 0;
};

}  // namespace vam::verdict
