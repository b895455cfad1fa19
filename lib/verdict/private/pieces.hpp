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

/// Two voxels are of one set if they share a face, or at least a corner.
enum class Touching { faces, corners };

/// pair(i, j) of all runs of two lists that have columns in common or next to each other, the other `rows_apart` rows
/// on. Both are in order.
void for_near_runs(const std::vector<VoxelRun>& runs, const std::vector<VoxelRun>& others, int rows_apart,
                   const std::function<void(std::size_t i, std::size_t j)>& pair);

/// Of a set of runs: what its runs have together.
struct RunSet {
  std::int64_t voxels = 0;
  VoxelPlace at = {};           // the middle of one of the runs
  std::int64_t torn = 0;        // of missing ones: voxels around which nothing is kept, or what is falls apart
  std::int64_t counted = 0;     // of these, those of torn sets that count
  std::int64_t apart = 0;       // of torn ones: voxels around which the kept ones fall apart
  std::size_t missing_run = 0;  // of torn ones: a run of the missing set that they are of

  void take(const RunSet& other) {
    voxels += other.voxels;
    torn += other.torn;
    counted += other.counted;
    apart += other.apart;
  }
};

/// Sets of runs, which are numbered in the order in which they come.
class RunSets {
 public:
  /// The next slice, as of BitSlice::runs().
  void add(const std::vector<VoxelRun>& slice, Touching touching);
  /// The last slice, and the number of its first run.
  [[nodiscard]] const std::vector<VoxelRun>& last() const { return last_; }
  [[nodiscard]] std::size_t first_of_last() const { return parent_.size() - last_.size(); }
  [[nodiscard]] std::size_t runs() const { return parent_.size(); }
  /// The representative of the run's set.
  [[nodiscard]] std::size_t set_of(std::size_t run) const;
  /// Of the set that this run is of.
  [[nodiscard]] RunSet& operator[](std::size_t run) { return sets_[set_of(run)]; }
  [[nodiscard]] const RunSet& operator[](std::size_t run) const { return sets_[set_of(run)]; }
  /// Forgets all runs but those of the last slice, which are then numbered from 0 on; before that, complete(set) of the
  /// sets that do not reach it. Returns the representative of each earlier run's set, or `gone`.
  static constexpr std::size_t gone = ~std::size_t{0};
  std::vector<std::size_t> forget(const std::function<void(std::size_t set)>& complete);
  /// Two runs are of one set.
  void join(std::size_t a, std::size_t b);

 private:
  /// Runs of the last slice, and those of itself or of the one before.
  struct Lists {
    const std::vector<VoxelRun>&of, &others;
    std::size_t first, second;
  };
  void join_near(const Lists& lists, int rows_apart, Touching touching);

  mutable std::vector<std::size_t> parent_;  // of each run; paths are shortened when they are followed
  std::vector<RunSet> sets_;                 // each at its representative
  std::vector<VoxelRun> last_;
  int slices_ = 0;  // so far
};

/// Counts pieces, and those of at least so many voxels. Memory: the runs of two slices.
class PieceCounter {
 public:
  explicit PieceCounter(std::int64_t least_voxels) : least_(least_voxels) {}
  /// Joins runs of a slice, RunSets::last(), and of the one before, numbered just before these.
  using JoinMore = std::function<void(RunSets& sets, const std::vector<VoxelRun>& before)>;
  /// The next slice, as of BitSlice::runs().
  void add(const std::vector<VoxelRun>& slice, Touching touching, const JoinMore& join_more = {});
  [[nodiscard]] std::int64_t all() const { return counted(0); }
  [[nodiscard]] std::int64_t large() const { return counted(least_); }

 private:
  [[nodiscard]] std::int64_t counted(std::int64_t least) const;

  std::int64_t least_;
  RunSets open_;                           // that reach the last slice
  std::int64_t complete_ = 0, large_ = 0;  // the others
};

}  // namespace vam::verdict
