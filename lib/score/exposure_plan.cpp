// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/exposure_plan.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam::score {

double window_middle(const model::DoseMetrics& doses) {
  return doses.min_part > doses.max_void ? 0.5 * (doses.min_part + doses.max_void) : doses.iou_threshold;
}

double aimed_dose(const model::DoseMetrics& doses, std::optional<double> threshold) {
  const double quarter = 0.25 * (doses.min_part - doses.max_void);
  const double middle = window_middle(doses);
  return threshold && std::abs(*threshold - middle) <= quarter ? *threshold : middle;
}

ExposurePlan plan_exposure(const model::DoseMetrics& doses, double mj_cm3, const model::Printer& printer,
                           double turns_of_frames, std::optional<double> threshold) {
  constexpr double most_turns = 1e6;
  constexpr double rounding = 1e-9;  // a dose that needs 3.0000000001 turns is given 3
  const double critical = *printer.resin.critical_dose_mj_cm3;
  const double middle = mj_cm3 * window_middle(doses);
  const double aim = mj_cm3 * aimed_dose(doses, threshold);
  const double quarter = mj_cm3 * std::max(0.0, 0.25 * (doses.min_part - doses.max_void));
  if (!(middle > 0) || !(critical / middle <= most_turns)) {
    throw Error{Fault::data, "exposure: at full intensity the middle of the process window is at " +
                                 format_number(middle) + " mJ/cm3 per turn, and the critical dose is " +
                                 format_number(critical) + " mJ/cm3; " +
                                 (middle > 0 ? "the print would take more than " + format_number(most_turns) + " turns"
                                             : std::string("the part receives no light"))};
  }
  ExposurePlan plan;
  const double showings = std::max(1.0, std::ceil(critical / (middle + quarter) * (1 - rounding)));
  plan.turns = round_int(showings * turns_of_frames);
  plan.multiplier = std::min(1.0, critical / (aim * showings));
  plan.seconds = model::seconds_of(printer.stage, plan.turns);
  plan.peak_intensity_mw_cm2 = plan.multiplier * printer.projector.max_intensity_mw_cm2;
  return plan;
}

void add_to(Json& figures, const ExposurePlan& plan) {
  figures["turns"] = plan.turns;
  figures["duration_s"] = plan.seconds;
  figures["multiplier"] = plan.multiplier;
  figures["peak_intensity_mw_cm2"] = plan.peak_intensity_mw_cm2;
}

}  // namespace vam::score
