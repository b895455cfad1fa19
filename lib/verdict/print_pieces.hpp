// SPDX-License-Identifier: GPL-3.0-or-later
// Separate pieces of a part and of its print: a wall that is cut off, or two walls that are joined, have no wrong voxel
// where only voxels that the surface cuts lie between.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "model/circle.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::verdict {

/// A voxel of a volume.
struct VoxelPlace {
  int column = 0, row = 0, slice = 0;
  bool operator==(const VoxelPlace&) const = default;
};

/// Voxels of one kind of defect.
struct Defects {
  std::int64_t voxels = 0;   // of all
  std::int64_t largest = 0;  // of these, that hang together
  VoxelPlace at = {};        // one of them
  bool operator==(const Defects&) const = default;
};

/// By how much less or more dose than the nominal one a verdict must stay as it is, relative to it: what of a print
/// hangs together only within it is in doubt.
inline constexpr double dose_margin = 0.02;

struct PrintPieces {
  static constexpr std::int64_t least_voxels = 8;  // of a piece: smaller ones are rounded tips and edges
  int part = 0;          // of voxels with a trace of it that share a corner: thin rods hold together
  int part_at_half = 0;  // of the coverage at a half: narrow gaps part it
  int print = 0;         // of the dose at the threshold
  int print_fewer = 0;   // and by how many it is in fewer or more with half and all of dose_margin less and more
  int print_more = 0;
  Defects broken = {};     // of the part
  Defects shut = {};       // of gaps
  std::int64_t holes = 0;  // tunnels of the print, smooth ones [SmoothPrint], beyond those of the part; not less than 0
  std::int64_t firm_holes = 0;  // of these, on which dose_margin does not decide [firm_dose]
  int solids = 0;               // of the part's own surface; 0: not known
  int specks = 0;               // of these, so small that they may not count

  [[nodiscard]] bool loses_walls() const { return broken.voxels > 0; }
  [[nodiscard]] bool bridges_gaps() const { return shut.voxels > 0; }
  [[nodiscard]] bool has_holes() const { return firm_holes > 0; }
  [[nodiscard]] bool may_have_holes() const { return holes > 0; }
  /// In how many pieces the part is, as far as its surface or the two numbers tell.
  [[nodiscard]] int fewest() const { return solids > 0 ? solids - specks : std::min(part, part_at_half); }
  [[nodiscard]] int most() const { return solids > 0 ? solids : std::max(part, part_at_half); }
  [[nodiscard]] bool knows_pieces() const { return solids > 0 || part == part_at_half; }
  [[nodiscard]] bool is_in_other_pieces() const { return print < fewest() || print > most(); }
  [[nodiscard]] int print_least() const { return print - print_fewer; }
  [[nodiscard]] int print_most() const { return print + print_more; }
  [[nodiscard]] bool may_be_in_other_pieces() const { return print_least() < fewest() || print_most() > most(); }
  [[nodiscard]] bool holds_margin() const { return !may_have_holes() && !may_be_in_other_pieces(); }
  [[nodiscard]] bool is_certain() const { return knows_pieces() && holds_margin(); }
  [[nodiscard]] bool is_as_part() const {
    return !is_in_other_pieces() && !loses_walls() && !bridges_gaps() && !has_holes();
  }
};

/// Where a slice is judged: in the circle, none: everywhere, and beyond it where the part has some of a voxel; void
/// there is not judged, and does not cure.
class JudgedRegion {
 public:
  JudgedRegion(int width, int height, const std::optional<model::Circle>& circle) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) inside_.push_back(!circle || circle->contains(x, y));
    }
  }
  [[nodiscard]] std::size_t pixels() const { return inside_.size(); }
  [[nodiscard]] bool has(std::size_t pixel, float coverage) const {
    return inside_[pixel] || model::label_of(coverage) != model::Label::void_;
  }

 private:
  std::vector<bool> inside_;
};

/// Slice by slice, from the lowest up.
class PrintPieceCounter {
 public:
  /// threshold: more than 0. circle: as of JudgedRegion.
  PrintPieceCounter(int width, int height, double threshold, const std::optional<model::Circle>& circle = {});
  ~PrintPieceCounter();
  PrintPieceCounter(PrintPieceCounter&&) noexcept;
  PrintPieceCounter& operator=(PrintPieceCounter&&) noexcept;
  /// The next `count` slices, row-major: dose, 0 where it is not judged, and coverage 0...1.
  void add(const float* dose, const float* coverage, int count);
  /// Of the slices so far, beyond which is nothing.
  [[nodiscard]] PrintPieces found() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::verdict
