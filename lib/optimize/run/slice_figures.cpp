// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/slice_figures.hpp"

#include <algorithm>
#include <cmath>

namespace vam::optimize {

void SliceFigures::add(const model::DoseMetrics& slice, int times) {
  if (times == 0) return;
  const double n = times;
  const double part = n * static_cast<double>(slice.part);
  counted_ += n * static_cast<double>(slice.part + slice.void_);
  errors_ += n * slice.ver * static_cast<double>(slice.part + slice.void_);
  if (slice.part == 0) return;
  part_ += part;
  iou_ += part * slice.iou;
  cv_squared_ += part * slice.cv * slice.cv;
  latitude_ = std::min(latitude_, slice.latitude);
  pw_ = std::min(pw_, slice.pw);
  ipdr_ = std::max(ipdr_, slice.ipdr);
}

void SliceFigures::add(const SliceFigures& other) {
  part_ += other.part_;
  counted_ += other.counted_;
  errors_ += other.errors_;
  iou_ += other.iou_;
  cv_squared_ += other.cv_squared_;
  latitude_ = std::min(latitude_, other.latitude_);
  pw_ = std::min(pw_, other.pw_);
  ipdr_ = std::max(ipdr_, other.ipdr_);
}

model::DoseMetrics SliceFigures::mean() const {
  model::DoseMetrics m;
  m.part = static_cast<std::int64_t>(part_);
  m.void_ = static_cast<std::int64_t>(counted_ - part_);
  m.ver = counted_ > 0 ? errors_ / counted_ : 0.0;
  if (part_ <= 0) return m;
  m.iou = iou_ / part_;
  m.cv = std::sqrt(cv_squared_ / part_);
  m.latitude = latitude_;
  m.pw = pw_;
  m.ipdr = ipdr_;
  return m;
}

const std::vector<std::string>& SliceFigures::names() {
  static const std::vector<std::string> all{"latitude", "ver", "pw", "ipdr", "cv", "iou"};
  return all;
}

}  // namespace vam::optimize
