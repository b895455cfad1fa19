// SPDX-License-Identifier: GPL-3.0-or-later
// Where a print has lost what it needs to be whole: walls and rods that are cut, gaps and channels that are shut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "verdict/defect_voxels.hpp"
#include "verdict/private/pieces.hpp"

namespace vam::verdict {

/// A slice of it, from three slices of printed:: bits.
struct TornSlice {
  std::vector<VoxelRun> lost;
  std::vector<std::int64_t> torn_of_lost;  // of each run: its torn voxels
  std::vector<VoxelRun> torn;              // parts of the lost ones
  std::vector<std::size_t> lost_run;       // that each torn run is a part of
  std::vector<std::int64_t> apart;         // of each torn run: voxels around which what is left falls apart
  std::vector<VoxelRun> rim;               // left, with a lost one among their 26 neighbours
};

/// slices: the middle one of three, nullptr beyond the volume, where nothing is lost and void is left.
[[nodiscard]] TornSlice torn_slice(Torn what, int width, int height, const std::uint8_t* const* slices);

/// Sets of lost voxels that touch, slice by slice, from the lowest up. A set counts if the left voxels that touch it
/// are in more than one piece, as at a rod that is cut, or in none, as of a cavity. Of others those torn voxels count
/// that touch and are many: three around which the rest falls apart, or 27 of a part, three of a gap, around which
/// nothing is left. Less is a rough face, or the tip of a sharp edge. Memory: what touches in two slices, and the sets
/// around which pieces are still open.
class TornSets {
 public:
  explicit TornSets(Torn what) : least_torn_(what == Torn::part ? 27 : 3) {}
  void add(const TornSlice& slice);
  /// That count.
  [[nodiscard]] std::int64_t voxels() const { return found().voxels; }
  [[nodiscard]] Defects found() const;

 private:
  /// Of left voxels: the run that stands for it in the last slice, or of one that ends before, a number of its own.
  using Piece = std::size_t;
  static constexpr Piece ended = ~(~Piece{0} >> 1U);
  /// A set that is torn if these pieces stay apart.
  struct Undecided {
    std::int64_t voxels;  // that are not counted as torn
    VoxelPlace at;        // one of the set
    std::vector<Piece> pieces;
  };

  void note_touching(const std::vector<VoxelRun>& lost, std::size_t first_lost, const std::vector<VoxelRun>& rim,
                     std::size_t first_rim);
  [[nodiscard]] std::vector<Piece> forget_rim();
  void decide();
  void decide_torn();
  void judge(bool is_whole, Undecided set);
  void count(std::int64_t voxels, const VoxelPlace& at);
  void judge_undecided(const std::vector<Piece>& now);

  std::int64_t least_torn_;
  RunSets lost_, torn_, rim_;
  std::vector<std::int64_t> torn_of_lost_, counted_;     // of each lost run or, at the run that stands for it, set
  std::vector<std::int64_t> apart_;                      // of each torn one, likewise
  std::vector<std::size_t> lost_of_torn_;                // the lost run that a torn one is of
  std::vector<std::pair<std::size_t, Piece>> touching_;  // a lost run and a piece
  std::vector<Undecided> undecided_;
  std::size_t ended_pieces_ = 0;
  Defects found_;  // of what is decided
};

}  // namespace vam::verdict
