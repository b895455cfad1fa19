// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces of a part and of what a dose cures of it.
#pragma once

#include <vector>

#include "model/circle.hpp"
#include "model/print_pieces.hpp"

namespace vam::score {

/// Gathers slices in ascending order.
class CuredPieces {
 public:
  /// Outside the circle only voxels of the part cure. threshold: more than 0, in the dose's unit.
  CuredPieces(const model::Circle& circle, double threshold, int width, int height);
  /// `count` row-major slices of dose and of target coverage.
  void add(const float* dose, const float* target, int count);
  [[nodiscard]] model::PrintPieces found() const { return counter_.found(); }

 private:
  std::vector<bool> inside_;  // of a slice, whether the circle has it
  model::PrintPieceCounter counter_;
};

}  // namespace vam::score
