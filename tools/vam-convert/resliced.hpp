// SPDX-License-Identifier: GPL-3.0-or-later
// Slices at other heights.
#pragma once

#include <deque>

#include "base/image.hpp"
#include "vam-convert/slices.hpp"

namespace vam::convert_tool {

/// Interpolated linearly between slices; beyond half a slice from the last one it is dark.
class Resliced {
 public:
  /// `count` slices, the first at `first` of those that come, each `step` of them higher. Where that is more than one,
  /// they are `averaged` over it.
  Resliced(Slices& slices, int count, double first, double step, bool averaged)
      : slices_(slices), count_(count), first_(first), step_(step), averaged_(averaged && step > 1) {}
  /// Upwards; false after the last.
  bool next(Image& slice);
  /// After the last: reads those above, with which all is known to be whole. The share of the light that lies below or
  /// above.
  double left_out();

 private:
  bool take();
  [[nodiscard]] double weight(int source, double place) const;

  Slices& slices_;
  int count_;
  double first_, step_;
  bool averaged_;
  std::deque<Image> window_;
  int front_ = 0;  // slice at the front of the window
  int done_ = 0;
  double light_ = 0;
  double beside_ = 0;
};

}  // namespace vam::convert_tool
