// The dose of a whole stack of slices, in printing order. The recursion runs from the last slice up but files are read
// from the first down, so the stack is read twice: once to know the dose at every 16th node, once to fill in between.
// Memory: one image per 16 slices, and 16 more.
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "resin/curethrough.hpp"

namespace vam::resin {

class StackDose {
 public:
  /// `full`: the Phi of a pixel of value 1 (pixels are intensities as fractions of the maximum, so phi_max).
  StackDose(const Limits& limits, double full);

  /// First reading: every slice in printing order. Throws Fault::data when a slice differs in size from the first.
  void add(const Image& slice);
  /// Between the readings.
  void turn();
  /// Second reading, `block_slices` slices at a time, in printing order (fewer only at the end): below[i] becomes Omega
  /// at the node below block[i], node n + 1 of slice n. All else follows from it: dose_at_centre(), cured_fraction().
  void replay(std::span<const Image> block, std::vector<Image>& below);

  static constexpr int block_slices = 16;
  [[nodiscard]] int slices() const { return slices_; }

 private:
  Limits limits_;
  double full_;
  int slices_ = 0;
  double weight_ = 1;             // q^(slices since the block's first)
  std::vector<double> gathered_;  // of the block that add() is in
  std::vector<Image> at_start_;   // Omega at the first node of every block; one more, 0, at the end
  std::size_t replayed_ = 0;
  bool turned_ = false;
};

}  // namespace vam::resin
