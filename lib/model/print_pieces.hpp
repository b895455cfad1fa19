// SPDX-License-Identifier: GPL-3.0-or-later
// Separate pieces of a part and of its print: a wall that is cut off, or two walls that are joined, have no wrong voxel
// where only voxels that the surface cuts lie between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/dose_metrics.hpp"

namespace vam::model {

/// Voxels of a row that are of a solid: [begin, end).
struct VoxelRun {
  int row, begin, end;
};

/// The runs of a slice, row by row, of the voxels with solid(pixel).
template <class Solid>
[[nodiscard]] std::vector<VoxelRun> runs_of(int width, int height, const Solid& solid) {
  std::vector<VoxelRun> runs;
  for (int row = 0; row < height; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    for (int x = 0; x < width; ++x) {
      if (!solid(first + static_cast<std::size_t>(x))) continue;
      const int begin = x;
      while (x < width && solid(first + static_cast<std::size_t>(x))) ++x;
      runs.push_back({row, begin, x});
    }
  }
  return runs;
}

/// Voxels that share a corner are of one piece.
class PieceCounter {
 public:
  /// The next slice, as of runs_of().
  void add(const std::vector<VoxelRun>& slice);
  /// Pieces of at least so many voxels.
  [[nodiscard]] int count(std::int64_t least_voxels) const;

 private:
  [[nodiscard]] std::size_t root(std::size_t run) const;
  void join(std::size_t a, std::size_t b);
  /// Those of `slice`, whose first run has number `first`, with those of the slice or row before.
  void join_neighbours(const std::vector<VoxelRun>& slice, std::size_t first, const std::vector<VoxelRun>& before,
                       std::size_t first_before, int rows_apart);

  mutable std::vector<std::size_t> parent_;  // of every run so far; paths are shortened when they are followed
  std::vector<std::int64_t> voxels_;         // of the piece, at its root
  std::vector<VoxelRun> last_;               // slice
};

/// Of a voxel, as bits.
namespace printed {
inline constexpr std::uint8_t part = 1;   // at least half covered
inline constexpr std::uint8_t cured = 2;  // receives the threshold
inline constexpr std::uint8_t edge = 4;   // at least a quarter covered
}  // namespace printed
[[nodiscard]] constexpr std::uint8_t printed_bits(float coverage, bool cured) {
  return static_cast<std::uint8_t>((coverage >= static_cast<float>(half_surface) ? printed::part : 0) |
                                   (coverage >= 0.25F ? printed::edge : 0) | (cured ? printed::cured : 0));
}

/// Which voxels of the middle one of three slices of printed:: bits are broken, as PrintPieces counts them, by their
/// numbers; nullptr beyond the volume.
[[nodiscard]] std::vector<std::size_t> broken_voxels(int width, int height, const std::uint8_t* const* slices);

/// Counted are pieces of at least so many voxels: smaller ones are rounded tips and edges.
struct PrintPieces {
  static constexpr std::int64_t least_voxels = 8;
  int part = 0;   // of voxels that are at least a quarter covered: rods of a voxel's width hold together
  int print = 0;  // of voxels that cure
  /// Voxels of the part that do not cure, and around which none of it cures, as in a hole of a wall, or what cures
  /// falls apart, as at the foot of a wall that stands free in the print or hangs on by its ends.
  std::int64_t broken = 0;

  [[nodiscard]] bool is_as_part() const { return print == part && broken < least_voxels; }
};

/// Slice by slice, from the lowest up.
class PrintPieceCounter {
 public:
  PrintPieceCounter(int width, int height) : width_(width), height_(height) {}
  /// The next slices, each row-major, of printed:: bits.
  void add(const std::vector<std::vector<std::uint8_t>>& slices);
  /// Of the slices so far, beyond which is nothing.
  [[nodiscard]] PrintPieces found() const;

 private:
  using Slice = std::vector<std::uint8_t>;
  [[nodiscard]] std::int64_t broken(const Slice* below, const Slice& slice, const Slice* above) const;

  int width_, height_;
  PieceCounter part_, print_;
  std::vector<Slice> last_;  // up to two
  std::int64_t broken_ = 0;  // in all but the last slice
};

}  // namespace vam::model
