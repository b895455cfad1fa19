// SPDX-License-Identifier: GPL-3.0-or-later
// The threshold dose that gives the largest intersection over union [physics §7].
#pragma once

#include <cstdint>

namespace vam::model {

/// Best IoU over all thresholds: going down through the bins, the print grows by the voxels of each bin.
struct BestThreshold {
  std::int64_t part_total;
  std::int64_t part = 0, void_ = 0;
  double iou = -1, high = 0, low = 0;
  bool plateau = false;  // the last bin visited had the best IoU: thresholds down to the next bin give the same print

  void visit(double lower, double upper, std::int64_t parts, std::int64_t voids) {
    if (plateau) low = upper;
    plateau = false;
    part += parts;
    void_ += voids;
    const double now = static_cast<double>(part) / static_cast<double>(part_total + void_);
    if (now <= iou) return;
    iou = now;
    high = lower;
    low = 0;
    plateau = true;
  }
};

}  // namespace vam::model
