// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of voxels that hang together, slice by slice, from the lowest up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "verdict/print_pieces.hpp"

namespace vam::verdict {

/// Voxels of a row that are of a solid: [begin, end). Those of a slice come in order [BitSlice::runs].
struct VoxelRun {
  int row, begin, end;
};

/// Two voxels of a row and its neighbour rows, or of neighbouring slices.
struct VoxelPair {
  int x, y;    // of the one, in the slice that is added
  int dx, dy;  // to the other
  bool below;  // the other is in the slice before
};

/// Whether two voxels that share an edge or a corner are of one piece.
using Joins = std::function<bool(const VoxelPair& pair)>;

/// pair(i, j) of all runs of two lists that have columns in common or next to each other, the other `rows_apart` rows
/// on. Both are in order.
void for_near_runs(const std::vector<VoxelRun>& runs, const std::vector<VoxelRun>& others, int rows_apart,
                   const std::function<void(std::size_t i, std::size_t j)>& pair);

/// Sets of runs. Voxels that share a face are of one set. Runs are numbered in the order in which they come.
class RunSets {
 public:
  /// The next slice, as of BitSlice::runs().
  void add(const std::vector<VoxelRun>& slice, const Joins& joins);
  /// The last slice, and the number of its first run.
  [[nodiscard]] const std::vector<VoxelRun>& last() const { return last_; }
  [[nodiscard]] std::size_t first_of_last() const { return parent_.size() - last_.size(); }
  [[nodiscard]] std::size_t runs() const { return parent_.size(); }
  /// The number of the run that stands for the set.
  [[nodiscard]] std::size_t set_of(std::size_t run) const;
  /// Of the set that this run stands for.
  [[nodiscard]] std::int64_t voxels(std::size_t set) const { return voxels_[set]; }
  /// The middle of one of its runs.
  [[nodiscard]] const VoxelPlace& place(std::size_t set) const { return places_[set]; }
  /// Forgets all runs but those of the last slice, which are then numbered from 0 on; before that, complete(set) of the
  /// sets that do not reach it. Of each earlier run the number of the run that stands for its set, or `gone`.
  static constexpr std::size_t gone = ~std::size_t{0};
  std::vector<std::size_t> forget(const std::function<void(std::size_t set)>& complete);
  /// Two runs are of one set.
  void join(std::size_t a, std::size_t b);

 private:
  /// Of the last slice and, where `below` is not set, itself, else the one before.
  struct Lists {
    const std::vector<VoxelRun>&of, &others;
    std::size_t first, second;
    bool below;
  };
  void join_faces(const Lists& lists, int rows_apart);
  void join_edges(const Lists& lists, int rows_apart, const Joins& joins);

  mutable std::vector<std::size_t> parent_;  // of each run; paths are shortened when they are followed
  std::vector<std::int64_t> voxels_;         // of the set, at the run that stands for it
  std::vector<VoxelPlace> places_;           // of each run
  std::vector<VoxelRun> last_;
  int slices_ = 0;  // so far
};

/// Voxels that touch, by a corner at least, are of one set.
[[nodiscard]] inline bool at_corners(const VoxelPair& /*pair*/) { return true; }
/// Only those that share a face are.
[[nodiscard]] inline bool by_faces_only(const VoxelPair& /*pair*/) { return false; }

/// Counts pieces of at least so many voxels. Memory: the runs of two slices.
class PieceCounter {
 public:
  explicit PieceCounter(std::int64_t least_voxels) : least_(least_voxels) {}
  /// The next slice, as of BitSlice::runs().
  void add(const std::vector<VoxelRun>& slice, const Joins& joins);
  [[nodiscard]] int count() const;

 private:
  std::int64_t least_;
  RunSets open_;      // that reach the last slice
  int complete_ = 0;  // the others
};

/// Counts pieces of a field at a level > 0: its voxels that reach it, joined across an edge where the bilinear
/// interpolation between them does, and across a corner where the mean of the eight voxels around it does.
class FieldPieces {
 public:
  FieldPieces(int width, int height, double level, std::int64_t least_voxels)
      : width_(width), height_(height), level_(level), counter_(least_voxels) {}
  /// The next slice, row-major.
  void add(std::vector<float> slice);
  [[nodiscard]] int count() const { return counter_.count(); }

 private:
  [[nodiscard]] bool joins(const VoxelPair& pair, const std::vector<float>& slice) const;

  int width_, height_;
  double level_;
  PieceCounter counter_;
  std::vector<float> last_;
};

}  // namespace vam::verdict
