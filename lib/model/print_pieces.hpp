// SPDX-License-Identifier: GPL-3.0-or-later
// Separate pieces of a part and of its print: a wall that is cut off, or two walls that are joined, have no wrong voxel
// where only voxels that the surface cuts lie between.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
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

/// Two voxels of a row and its neighbour rows, or of neighbouring slices.
struct VoxelPair {
  int x, y;    // of the one, in the slice that is added
  int dx, dy;  // to the other
  bool below;  // the other is in the slice before
};

/// Whether two voxels that share an edge or a corner are of one piece.
using Joins = std::function<bool(const VoxelPair& pair)>;

/// Voxels that share a face are of one piece.
class PieceCounter {
 public:
  /// The next slice, as of runs_of().
  void add(const std::vector<VoxelRun>& slice, const Joins& joins);
  /// Pieces of at least so many voxels.
  [[nodiscard]] int count(std::int64_t least_voxels) const;

 private:
  /// The first of two lists of runs has the number `first`, the second `second`.
  struct Lists {
    const std::vector<VoxelRun>&of, &others;
    std::size_t first, second;
    bool below;
  };

  [[nodiscard]] std::size_t root(std::size_t run) const;
  void join(std::size_t a, std::size_t b);
  template <class Pair>
  void for_near_runs(const Lists& lists, int rows_apart, const Pair& pair) const;
  void join_faces(const Lists& lists, int rows_apart);
  void join_edges(const Lists& lists, int rows_apart, const Joins& joins);

  mutable std::vector<std::size_t> parent_;  // of every run so far; paths are shortened when they are followed
  std::vector<std::int64_t> voxels_;         // of the piece, at its root
  std::vector<VoxelRun> last_;               // slice
};

/// The pieces of a field at a level: its voxels that reach it, joined where the field between them does, interpolated
/// linearly along each axis.
class FieldPieces {
 public:
  FieldPieces(int width, int height, double level) : width_(width), height_(height), level_(level) {}
  /// The next slice, row-major.
  void add(std::vector<float> slice);
  [[nodiscard]] int count(std::int64_t least_voxels) const { return counter_.count(least_voxels); }

 private:
  [[nodiscard]] bool joins(const VoxelPair& pair, const std::vector<float>& slice) const;

  int width_, height_;
  double level_;
  PieceCounter counter_;
  std::vector<float> last_;
};

/// Of a voxel, as bits.
namespace printed {
inline constexpr std::uint8_t part = 1;   // at least half covered
inline constexpr std::uint8_t cured = 2;  // receives the threshold
inline constexpr std::uint8_t edge = 4;   // at least a quarter covered
inline constexpr std::uint8_t trace = 8;  // covered by more than rounding: thin rods are no more
}  // namespace printed
[[nodiscard]] constexpr std::uint8_t printed_bits(float coverage, bool cured) {
  return static_cast<std::uint8_t>((coverage >= static_cast<float>(half_surface) ? printed::part : 0) |
                                   (coverage >= 0.25F ? printed::edge : 0) |
                                   (coverage >= 1 / 32.0F ? printed::trace : 0) | (cured ? printed::cured : 0));
}

/// What a print loses: part that does not cure and around which no part cures, as in a hole of a wall, or what cures
/// falls apart, as at the foot of a wall that stands free in the print or hangs on by its ends; and in the same way
/// void that cures, as in a channel that is shut.
enum class Torn { part, gap };

/// Which voxels of the middle one of three slices of printed:: bits are torn, by their numbers; nullptr beyond the
/// volume. Of gaps, only voxels that are less than a quarter covered are.
[[nodiscard]] std::vector<std::size_t> torn_voxels(Torn what, int width, int height, const std::uint8_t* const* slices);

/// Counted are pieces of at least so many voxels: smaller ones are rounded tips and edges.
struct PrintPieces {
  static constexpr std::int64_t least_voxels = 8;
  static constexpr std::int64_t least_torn = 3;  // one or two may be of a rough edge
  int part = 0;             // of voxels with a trace of it that share a corner: thin rods hold together
  int part_at_half = 0;     // of the coverage at a half: narrow gaps part it
  int print = 0;            // of the dose at the threshold
  std::int64_t broken = 0;  // torn voxels of the part
  std::int64_t shut = 0;    // and of gaps

  [[nodiscard]] bool loses_walls() const { return broken >= least_torn; }
  [[nodiscard]] bool shuts_gaps() const { return shut >= least_torn; }
  /// Whether voxels show in how many pieces the part is.
  [[nodiscard]] bool is_certain() const { return part == part_at_half; }
  [[nodiscard]] bool is_in_other_pieces() const {
    return print < std::min(part, part_at_half) || print > std::max(part, part_at_half);
  }
  [[nodiscard]] bool is_as_part() const { return !is_in_other_pieces() && !loses_walls() && !shuts_gaps(); }
};

/// Slice by slice, from the lowest up.
class PrintPieceCounter {
 public:
  PrintPieceCounter(int width, int height, double threshold);
  /// The next slices, row-major: coverage 0...1, and dose, 0 where it is not judged.
  void add(int count, const float* coverage, const float* dose);
  /// Of the slices so far, beyond which is nothing.
  [[nodiscard]] PrintPieces found() const;

 private:
  using Slice = std::vector<std::uint8_t>;  // of bits
  struct TornVoxels {
    std::int64_t broken = 0, shut = 0;
  };
  [[nodiscard]] TornVoxels torn(const Slice* below, const Slice& slice, const Slice* above) const;

  int width_, height_;
  double threshold_;
  PieceCounter part_;
  FieldPieces part_at_half_, print_;
  std::vector<Slice> last_;  // up to two
  TornVoxels torn_;          // in all but the last slice
};

}  // namespace vam::model
