// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of many slices while they are being optimised, each still at its own scale.
#pragma once

#include <string>
#include <vector>

#include "model/dose/dose_metrics.hpp"

namespace vam::optimize {

/// Every slice is judged at its own best threshold and largest dose, which is fair because they are brought to one
/// threshold in the end. VER and IoU are means by voxel count, CV the root mean square; latitude and PW
/// are those of the worst slice, IPDR the largest.
class SliceFigures {
 public:
  void add(const model::DoseMetrics& slice, int times = 1);
  void add(const SliceFigures& other);
  [[nodiscard]] model::DoseMetrics mean() const;

  /// Hands over every field, for Archive.
  template <class Fields>
  void exchange(Fields& fields) {
    for (double* field : {&part_, &counted_, &errors_, &iou_, &cv_squared_, &latitude_, &pw_, &ipdr_}) fields(*field);
  }

  /// latitude, ver, pw, ipdr, cv, iou
  static const std::vector<std::string>& names();

 private:
  double part_ = 0, counted_ = 0, errors_ = 0, iou_ = 0, cv_squared_ = 0;
  double latitude_ = 2, pw_ = 2, ipdr_ = 0;
};

}  // namespace vam::optimize
