// SPDX-License-Identifier: GPL-3.0-or-later
// Grey levels whose errors cancel in the dose: error diffusion over columns, stage angles and turns.
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "resin/response.hpp"

namespace vam::resin {

/// The error of a pixel goes to its neighbours, 7/16 to the next column and 3/16, 5/16, 1/16 to the columns around it
/// at the next angle [FS76]. A pixel is rounded to a step, of which there are `turns` from each level to the next: the
/// higher level is shown in that number of turns, and the sum over all turns is that of the step. Pixels that are dark
/// remain dark [physics §6].
class Dither {
 public:
  /// At least one turn.
  Dither(const GreyLevels& levels, int turns);
  [[nodiscard]] int turns() const { return turns_; }

  /// One row at one angle: `wanted`, fractions of full intensity, to steps. `carried`: what the angle before left for
  /// each column, 0 at first; becomes what this one leaves. Columns are visited from the last one if backwards, which
  /// is to alternate with the angle.
  void row(std::span<const float> wanted, bool backwards, std::span<float> carried, std::span<int> steps) const;

  /// Mean over the turns, a fraction of full intensity.
  [[nodiscard]] float intensity(int step) const;
  /// The grey level in one of the turns, 0 ... turns() - 1. `phase` differs between neighbours, so that not all pixels
  /// of a step change in the same turn.
  [[nodiscard]] int level(int step, int turn, int phase) const;

 private:
  [[nodiscard]] int nearest(float wanted) const;
  int turns_;
  std::vector<int> levels_;       // those that differ in intensity, rising
  std::vector<float> intensity_;  // of each
};

/// What is shown of a sinogram, columns x angles, mean over the turns; all in fractions of full intensity.
[[nodiscard]] Image dithered(const Image& sinogram, const Dither& dither);

}  // namespace vam::resin
