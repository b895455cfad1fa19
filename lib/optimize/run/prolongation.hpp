// SPDX-License-Identifier: GPL-3.0-or-later
// From the projections of a coarser problem to those of a finer one.
#pragma once

#include <vector>

#include "base/image.hpp"

namespace vam::optimize {

/// Samples at first, first + step, ... of a coordinate.
struct Samples {
  int count = 0;
  double first = 0;
  double step = 1;
};

/// Where the samples of a stack of sinograms are: columns and slices in mm, stage angles over one turn in degrees.
struct StackSamples {
  Samples columns, angles, slices;
};

/// Linear between columns, stage angles, which are periodic, and slices; beyond the first and the last column and slice
/// their values go on.
class Prolongation {
 public:
  /// `coarse`: slices, angles x columns each.
  Prolongation(std::vector<Image> coarse, const StackSamples& from, const StackSamples& to);
  /// The finer slice of that number. Several threads may ask at once.
  [[nodiscard]] Image operator()(int k) const;

 private:
  struct SampleWeights {  // coarse samples, and the second one's weight
    int first = 0, second = 0;
    float weight = 0;
  };
  static std::vector<SampleWeights> sample_weights(const Samples& from, const Samples& to, bool periodic);
  std::vector<Image> coarse_;
  std::vector<SampleWeights> columns_, angles_, slices_;
};

}  // namespace vam::optimize
