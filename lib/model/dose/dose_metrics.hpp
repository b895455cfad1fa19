// SPDX-License-Identifier: GPL-3.0-or-later
// How well a dose separates part from void: the figures of merit of the field, gathered slice by slice in one pass.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "model/dose/dose_histogram.hpp"

namespace vam::model {

/// What a voxel counts as. Surface voxels are cut by the part's surface (0 < coverage < 1).
enum class Label : std::uint8_t { outside = 0, part = 1, void_ = 2, surface = 3 };

/// Coverage within this distance of 0 or 1 is rounding, not surface.
inline constexpr float coverage_rounding = 1e-3F;

/// A voxel is of a body that covers at least half of it.
[[nodiscard]] constexpr bool half_covered(float coverage) { return coverage >= 0.5F; }
/// Coverage whose isosurface has voxels inside that are just half covered.
inline constexpr double half_surface = 0.5 - 1e-6;

[[nodiscard]] constexpr Label label_of(float coverage) {
  if (coverage >= 1.0F - coverage_rounding) return Label::part;
  return coverage <= coverage_rounding ? Label::void_ : Label::surface;
}

/// Latitude, process window, voxel error rate and their kin [OSMO21; physics §7]. G = part, V = void inside the
/// writable circle, x = dose. Doses keep the unit they came in; pw and ipdr are divided by max_dose when relative.
struct DoseMetrics {
  std::int64_t part = 0;   // #G
  std::int64_t void_ = 0;  // #V
  double min_part = 0;     // min_G x
  double max_part = 0;
  double mean_part = 0;
  double max_void = 0;       // max_V x
  double max_dose = 0;       // over G and V
  double ver = 0;            // #{V: x >= min_G x} / (#G + #V)
  double latitude = 0;       // (min_G x - max_V x) / their middle: a print forgives half of it of dose either way
  double pw = 0;             // min_G x - max_V x, positive is good
  double ipdr = 0;           // max_G x - min_G x
  double cv = 0;             // sigma_G / mean_G
  double iou = 0;            // best over thresholds of |print and part| / |print or part|
  double iou_threshold = 0;  // the middle of the thresholds that give it
};

/// What a print at one given threshold dose would be.
struct ThresholdMetrics {
  double threshold = 0;
  double part_cured = 0;  // fraction of G at or above it
  double void_cured = 0;  // fraction of V at or above it
  double iou = 0;
  double wrong = 0;  // (#G below + #V at or above) / (#G + #V)
};

/// Gathers doses; sums are exact counts and doubles. Adding slices in a fixed order gives the same bits every time.
class DoseStatistics {
 public:
  explicit DoseStatistics(std::optional<double> threshold = std::nullopt) : threshold_(threshold) {}

  void add(float dose, Label label) {
    if (label == Label::part) add_part(dose);
    if (label == Label::void_) add_void(dose);
  }
  /// Adds another's, as often as its slice occurs.
  void merge(const DoseStatistics& other, int times = 1);

  /// Hands over every sum: fields(value) for each, to be written or read. Extremes only where there are any.
  template <class Fields>
  void exchange(Fields& fields) {
    for (std::int64_t* count : {&part_, &void_, &part_cured_, &void_cured_}) fields(*count);
    if (part_ > 0) fields(min_part_);
    if (part_ > 0) fields(max_part_);
    if (void_ > 0) fields(max_void_);
    for (double* sum : {&sum_, &sum_squares_}) fields(*sum);
    part_histogram_.exchange(fields);
    void_histogram_.exchange(fields);
  }

  /// Metrics of everything added. Extremes are exact; VER and IoU resolve the dose to 2^-12 of its value, and VER
  /// counts void voxels in the bin of min_G as errors unless the extremes prove otherwise.
  [[nodiscard]] DoseMetrics metrics(bool relative = true) const;
  /// The same with min_G and max_V replaced by the alpha/2 percentiles, 0 <= alpha < 1.
  [[nodiscard]] DoseMetrics trimmed(double alpha, bool relative = true) const;
  /// At the threshold given to the constructor (exact), if any.
  [[nodiscard]] std::optional<ThresholdMetrics> at_threshold() const;
  /// At any threshold: counts resolve the dose to 2^-12 of it unless the extremes prove otherwise.
  [[nodiscard]] ThresholdMetrics at(double threshold) const;

 private:
  void add_part(float dose);
  void add_void(float dose);
  void fill(DoseMetrics& m, bool relative) const;
  [[nodiscard]] ThresholdMetrics cured(double threshold, std::int64_t part, std::int64_t void_cured) const;

  std::optional<double> threshold_;
  DoseHistogram part_histogram_, void_histogram_;
  std::int64_t part_ = 0, void_ = 0, part_cured_ = 0, void_cured_ = 0;
  float min_part_ = std::numeric_limits<float>::infinity();
  float max_part_ = -std::numeric_limits<float>::infinity();
  float max_void_ = -std::numeric_limits<float>::infinity();
  double sum_ = 0, sum_squares_ = 0;
};

/// Efficiency of light: mean over max of the projections' values [physics §7]; 0 for black ones.
struct LightEfficiency {
  double sum = 0;
  double max = 0;
  std::int64_t count = 0;
  void add(std::span<const float> values);
  [[nodiscard]] double value() const { return max > 0 ? sum / static_cast<double>(count) / max : 0.0; }
};

}  // namespace vam::model
