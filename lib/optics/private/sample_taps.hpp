// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolation weights of a sample at a fractional position of an even grid.
#pragma once

#include <vector>

namespace vam::optics {

/// Neighbours first .. first + weights.size() - 1 of the grid; the weights add up to 1. Indices may lie outside the
/// grid: the caller decides whether that wraps, clamps or is dark.
struct Taps {
  int first = 0;
  std::vector<float> weights;
};

/// The mean over `width` grid steps about `position`, with grid value k standing for [k - 1/2, k + 1/2], so that
/// nothing between the samples is lost.
[[nodiscard]] Taps mean_taps(double position, double width);

/// A sample at `position` (in grid steps) that is `width` grid steps wide. Up to one step it is interpolated linearly,
/// so a position on the grid gives that very value; a wider sample is the mean.
[[nodiscard]] Taps sample_taps(double position, double width);

}  // namespace vam::optics
