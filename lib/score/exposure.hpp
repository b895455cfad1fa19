// SPDX-License-Identifier: GPL-3.0-or-later
// How long to print: turns and seconds until the dose of one turn, (mu / Omega) integral I e^{-mu s} dtheta
// [CAL19 eq 1], adds up to the critical dose [physics §4]; how bright: light that puts that dose within the process
// window.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/image.hpp"
#include "base/text/json_fwd.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/printer.hpp"

namespace vam::score {

/// Doses of one turn, gathered slice by slice: of everything, and of the voxels that are wholly inside the part.
class TurnDoses {
 public:
  /// target: coverage 0..1 of the same voxels, or empty. Throws Fault::data for other sizes.
  void add(const Image& dose, const Image& target);
  [[nodiscard]] double largest() const { return largest_; }

  /// Fields of the report: dose_OF_max and _mean ("per_turn", "shown"), with a target also part_dose_OF_min and _mean,
  /// in mJ/cm3 or relative.
  [[nodiscard]] Json doses(const std::string& of, bool absolute, double scale) const;
  /// The turns and seconds until the mean of the part, and until all of it, has reached the critical dose, which the
  /// printer must have. Without a target the largest dose stands for the part.
  [[nodiscard]] Json exposures(const model::Printer& printer, double scale) const;

 private:
  double largest_ = 0;
  double sum_ = 0;
  double count_ = 0;
  double part_sum_ = 0;
  std::int64_t part_count_ = 0;
  double part_least_ = 0;
};

inline constexpr double most_turns = 1e6;

struct ExposurePlan {
  double turns = 0;       // whole ones, unless they were given
  double multiplier = 0;  // of full light, 0...1
  double seconds = 0;
  double peak_intensity_mw_cm2 = 0;  // of the brightest pixel
};

/// The fewest whole showings of the frames, in turns, at which full light brings the critical dose into the middle half
/// of the process window, and the fraction of full light, at most 1, that brings verdict::aimed_dose to it, or as near
/// as full light can [physics §4]. `doses` and `threshold` times `mj_cm3` are those of all frames once in full light,
/// which takes `turns_of_frames`. Throws Fault::data when the aim is not positive, or when they are shown more than a
/// million times. The printer must have a critical dose.
[[nodiscard]] ExposurePlan plan_exposure(const model::DoseMetrics& doses, double mj_cm3, const model::Printer& printer,
                                         double turns_of_frames = 1, std::optional<double> threshold = {});

/// turns, duration_s, multiplier and peak_intensity_mw_cm2, into a report.
void append_json(Json& figures, const ExposurePlan& plan);

}  // namespace vam::score
