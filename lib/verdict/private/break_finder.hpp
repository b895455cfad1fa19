// SPDX-License-Identifier: GPL-3.0-or-later
// Finds walls and rods that are cut, and gaps and channels that are shut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "verdict/defect_voxels.hpp"
#include "verdict/private/pieces.hpp"

namespace vam::verdict {

/// Of one slice, from three slices of printed:: bits. Missing and kept: as of Defect.
struct DefectSlice {
  std::vector<VoxelRun> missing;
  std::vector<std::int64_t> torn_of_missing;  // of each run: its torn voxels
  std::vector<VoxelRun> torn;                 // parts of the missing ones
  std::vector<std::size_t> missing_run;       // that each torn run is a part of
  std::vector<std::int64_t> apart;            // of each torn run: voxels around which the kept ones fall apart
  std::vector<VoxelRun> boundary;             // kept, with a missing one among their 26 neighbours
};

/// Of the middle one of three slices; nullptr beyond the volume, where nothing is missing and void is kept.
[[nodiscard]] DefectSlice defect_slice(Defect what, int width, int height, const std::uint8_t* const* slices);

/// Sets of missing voxels that touch, slice by slice, from the lowest up. A set counts if the kept voxels that touch it
/// are in more than one piece, as at a rod that is cut, or in none, as of a cavity. Of others those torn voxels count
/// that touch and are many: three around which the rest falls apart, or 27 of a part, three of a gap, around which
/// nothing is kept. Less is a rough face, or the tip of a sharp edge. Memory: what touches in two slices, and the sets
/// around which pieces are still open.
class BreakFinder {
 public:
  explicit BreakFinder(Defect what) : least_torn_(what == Defect::broken ? 27 : 3) {}
  void add(const DefectSlice& slice);
  /// That count.
  [[nodiscard]] std::int64_t voxels() const { return found().voxels; }
  [[nodiscard]] Defects found() const;

 private:
  /// Of kept voxels: the run that represents it in the last slice; if it ends before, a number of its own.
  using Piece = std::size_t;
  static constexpr Piece ended = ~(~Piece{0} >> 1U);
  /// A set that is torn if these pieces stay apart.
  struct Undecided {
    std::int64_t voxels;  // that are not counted as torn
    VoxelPlace at;        // one of the set
    std::vector<Piece> pieces;
  };

  void note_touching(const std::vector<VoxelRun>& missing, std::size_t first_missing,
                     const std::vector<VoxelRun>& boundary, std::size_t first_boundary);
  [[nodiscard]] std::vector<Piece> forget_boundary();
  void decide();
  void decide_torn();
  void judge(bool is_whole, Undecided set);
  void count(std::int64_t voxels, const VoxelPlace& at);
  void judge_undecided(const std::vector<Piece>& now);

  std::int64_t least_torn_;
  RunSets missing_, torn_, boundary_;
  std::vector<std::pair<std::size_t, Piece>> touching_;  // a missing run and a piece
  std::vector<Undecided> undecided_;
  std::size_t ended_pieces_ = 0;
  Defects found_;  // of what is decided
};

}  // namespace vam::verdict
