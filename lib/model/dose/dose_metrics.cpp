// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/dose_metrics.hpp"

#include <algorithm>
#include <cmath>

#include "model/dose/best_threshold.hpp"

namespace vam::model {

namespace {

double ratio(std::int64_t a, std::int64_t b) { return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0.0; }

}  // namespace

void DoseStatistics::add_part(float dose) {
  ++part_;
  part_histogram_.add(dose);
  min_part_ = std::min(min_part_, dose);
  max_part_ = std::max(max_part_, dose);
  sum_ += dose;
  sum_squares_ += dose * static_cast<double>(dose);
  if (threshold_ && dose >= *threshold_) ++part_cured_;
}

void DoseStatistics::add_void(float dose) {
  ++void_;
  void_histogram_.add(dose);
  max_void_ = std::max(max_void_, dose);
  if (threshold_ && dose >= *threshold_) ++void_cured_;
}

void DoseStatistics::merge(const DoseStatistics& other, int times) {
  part_histogram_.merge(other.part_histogram_, times);
  void_histogram_.merge(other.void_histogram_, times);
  part_ += times * other.part_;
  void_ += times * other.void_;
  part_cured_ += times * other.part_cured_;
  void_cured_ += times * other.void_cured_;
  min_part_ = std::min(min_part_, other.min_part_);
  max_part_ = std::max(max_part_, other.max_part_);
  max_void_ = std::max(max_void_, other.max_void_);
  sum_ += times * other.sum_;
  sum_squares_ += times * other.sum_squares_;
}

/// What follows from min_part and max_void, which the caller has set.
void DoseStatistics::fill(DoseMetrics& m, bool relative) const {
  m.part = part_;
  m.void_ = void_;
  m.max_part = part_ > 0 ? max_part_ : 0.0;
  m.max_dose = std::max(m.max_part, void_ > 0 ? max_void_ : 0.0);
  m.mean_part = part_ > 0 ? sum_ / static_cast<double>(part_) : 0.0;
  const double variance = part_ > 0 ? sum_squares_ / static_cast<double>(part_) - m.mean_part * m.mean_part : 0.0;
  m.cv = m.mean_part > 0 ? std::sqrt(std::max(0.0, variance)) / m.mean_part : 0.0;
  const double unit = relative && m.max_dose > 0 ? m.max_dose : 1.0;
  const double middle = 0.5 * (m.min_part + m.max_void);
  m.latitude = middle > 0 ? (m.min_part - m.max_void) / middle : 0.0;
  m.pw = (m.min_part - m.max_void) / unit;
  m.ipdr = (m.max_part - m.min_part) / unit;
  const bool apart = part_ == 0 || void_ == 0 || max_void_ < m.min_part;
  m.ver = apart ? 0.0 : ratio(void_histogram_.count_from(m.min_part), part_ + void_);
}

DoseMetrics DoseStatistics::metrics(bool relative) const {
  DoseMetrics m;
  m.min_part = part_ > 0 ? min_part_ : 0.0;
  m.max_void = void_ > 0 ? max_void_ : 0.0;
  fill(m, relative);
  if (part_ == 0) return m;
  if (m.max_void < m.min_part) {  // any threshold between the two prints the part exactly
    m.iou = 1.0;
    m.iou_threshold = 0.5 * (m.min_part + m.max_void);
    return m;
  }
  BestThreshold best{.part_total = part_};
  part_histogram_.descend(void_histogram_, [&](double lower, double upper, std::int64_t parts, std::int64_t voids) {
    best.visit(lower, upper, parts, voids);
  });
  m.iou = best.iou;
  m.iou_threshold = 0.5 * (best.low + best.high);
  return m;
}

DoseMetrics DoseStatistics::trimmed(double alpha, bool relative) const {
  DoseMetrics m = metrics(relative);
  m.min_part = part_histogram_.quantile(alpha / 2);
  m.max_void = void_histogram_.quantile(1 - alpha / 2);
  fill(m, relative);
  return m;
}

std::optional<ThresholdMetrics> DoseStatistics::at_threshold() const {
  if (!threshold_) return std::nullopt;
  return cured(*threshold_, part_cured_, void_cured_);
}

ThresholdMetrics DoseStatistics::at(double threshold) const {
  const bool all_part = min_part_ >= threshold;
  const bool no_void = max_void_ < threshold;
  return cured(threshold, all_part ? part_ : part_histogram_.count_from(threshold),
               no_void ? 0 : void_histogram_.count_from(threshold));
}

ThresholdMetrics DoseStatistics::cured(double threshold, std::int64_t part, std::int64_t void_cured) const {
  ThresholdMetrics m;
  m.threshold = threshold;
  m.part_cured = ratio(part, part_);
  m.void_cured = ratio(void_cured, void_);
  m.iou = ratio(part, part_ + void_cured);
  m.wrong = ratio(part_ - part + void_cured, part_ + void_);
  return m;
}

void LightEfficiency::add(std::span<const float> values) {
  for (const float v : values) {
    sum += v;
    max = std::max(max, static_cast<double>(v));
  }
  count += values.size();
}

}  // namespace vam::model
