// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of neighbouring rows in light that spreads along z.
#pragma once

#include <span>
#include <vector>

namespace vam::light {

/// Light of a row that is displaced by s rows falls on two of them, |s| and 1 - |s|, which spreads it by more than s^2,
/// and by 1/6 of a row^2 in the mean over all places; so does reading it linearly between rows, at the place p by
/// p (1 - p). Both do so once only.
///
/// Kernels {middle, first neighbours, ...} whose standard deviations are steps from 0 up to the largest one: chords of
/// a disc, sqrt(1 - (k / a)^2), with the a for which the variance is exact.
class RowSpread {
 public:
  RowSpread() : RowSpread(0) {}
  explicit RowSpread(double largest_rows);

  /// For light of that standard deviation in rows, which is read where the mean of p (1 - p) is `read`; 0: none.
  [[nodiscard]] int step(double rows, double read) const;
  [[nodiscard]] std::span<const float> weights(int step) const { return kernels_[static_cast<std::size_t>(step)]; }
  /// Neighbours on either side that count.
  [[nodiscard]] int half_width(int step) const { return static_cast<int>(weights(step).size()) - 1; }
  [[nodiscard]] int most() const { return half_width(static_cast<int>(kernels_.size()) - 1); }

 private:
  double steps_per_row_ = 0;
  std::vector<std::vector<float>> kernels_;
};

}  // namespace vam::light
