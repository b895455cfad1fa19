// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of a whole stack of slices, in printing order. The recursion runs from the last slice up but files are read
// from the first down, so the stack is read twice: once to know the dose at every 32nd node, once to fill in between.
// Memory: one image per 32 slices, and 32 more.
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "resin/curethrough/column_dose.hpp"

namespace vam::resin {

class StackDose {
 public:
  /// `full`: the Phi of a pixel of value 1 (pixels are intensities as fractions of the maximum, so phi_max).
  StackDose(const CureLimits& limits, double full);

  /// First reading: every slice in printing order. Throws Fault::data when a slice differs in size from the first.
  void add(const Image& slice);
  /// Call between the first and the second reading.
  void turn();
  /// Second reading, of row y of `block`, which begins with slice `first`, a multiple of block_slices, and is as long
  /// (shorter only at the end): below[i * width + x] becomes Omega at the node below slice first + i. All else follows
  /// from it: dose_at_centre(), cured_fraction(). In any order, by many threads at once.
  void replay_row(int first, std::span<const Image> block, int y, float* below) const;

  static constexpr int block_slices = 32;
  [[nodiscard]] int slices() const { return slices_; }

 private:
  CureLimits limits_;
  double full_;
  int slices_ = 0;
  double weight_ = 1;             // q^(slices since the block's first)
  std::vector<double> gathered_;  // of the block that add() is in
  std::vector<Image> at_start_;   // Omega at the first node of every block; one more, 0, at the end
  bool turned_ = false;
};

}  // namespace vam::resin
