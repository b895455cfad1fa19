// SPDX-License-Identifier: GPL-3.0-or-later
// How bright and how long to print: whole turns, and light that puts the resin's critical dose within the process
// window.
#pragma once

#include <optional>

#include "base/text/json_fwd.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/printer.hpp"

namespace vam::score {

struct ExposurePlan {
  int turns = 0;
  double multiplier = 0;  // of full light, 0...1
  double seconds = 0;
  double peak_intensity_mw_cm2 = 0;  // of the brightest pixel
};

/// The dose half way between the void's largest and the part's least; where void takes more than part, the middle of
/// the thresholds that print best. `doses` are absolute (DoseStatistics::metrics(false)), in any unit.
[[nodiscard]] double window_middle(const model::DoseMetrics& doses);

/// The dose that a print brings to the critical one: the threshold that its light was made for, while that is in the
/// middle half of the window, as the dose at the part's surface is that; else the window's middle.
[[nodiscard]] double aimed_dose(const model::DoseMetrics& doses, std::optional<double> threshold);

/// The fewest whole showings of the frames, in turns, at which full light brings the critical dose into the middle half
/// of the process window, and the fraction of full light, at most 1, that brings the aimed dose to it, or as near as
/// full light can [physics §4]. `doses` and `threshold` times `mj_cm3` are those of all frames once in full light,
/// which takes `turns_of_frames`. Throws Fault::data when the aim is not positive, or when they are shown more than a
/// million times. The printer must have a critical dose.
[[nodiscard]] ExposurePlan plan_exposure(const model::DoseMetrics& doses, double mj_cm3, const model::Printer& printer,
                                         double turns_of_frames = 1, std::optional<double> threshold = {});

/// turns, duration_s, multiplier and peak_intensity_mw_cm2, into a report.
void add_to(Json& figures, const ExposurePlan& plan);

}  // namespace vam::score
