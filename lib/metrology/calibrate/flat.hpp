// SPDX-License-Identifier: GPL-3.0-or-later
// The camera's flat field: many frames of an even scene, for vam-ost --flat.
#pragma once

#include "base/image.hpp"
#include "base/stats/measured.hpp"

namespace vam::metrology {

/// Sums of frames, so that a scan of any length fits in memory.
class FrameMean {
 public:
  /// Throws Fault::data when a frame has another size.
  void add(const Image& frame);
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] Image mean() const;
  /// Noise of one frame, RMS over the pixels, what all frames share left out. Needs two frames.
  [[nodiscard]] double noise() const;

 private:
  int width_ = 0;
  int height_ = 0;
  int count_ = 0;
  std::vector<double> sum_;
  std::vector<double> square_;
};

struct FlatField {
  Image field;             // mean 1; dead pixels have the mean of their neighbours
  stats::Measured level;   // mean of the scene in camera units, dark subtracted; sigma of one frame's mean is not known
  double unevenness = 0;   // (99th - 1st percentile) / 2, part of the mean
  double pixel_sigma = 0;  // of a pixel of the field, part of the mean
  int dead = 0;            // pixels below a fifth of the mean
};

/// (mean - dark) / its mean; dark_sigma is that of a pixel of the dark. An empty dark is 0. Throws Fault::data: fewer
/// than 3 frames, no light, sizes that differ, more than 1 % dead pixels, or over-exposed frames.
[[nodiscard]] FlatField flat_field(const FrameMean& frames, const Image& dark, double dark_sigma = 0);

}  // namespace vam::metrology
