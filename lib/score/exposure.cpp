// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/exposure.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "verdict/verdict.hpp"

namespace vam::score {

namespace {

// Turns of this dose until the critical dose, and their time; null when no turn adds anything.
void add_exposure(Json& figures, const std::string& of, double dose, const model::Printer& printer) {
  const double turns = std::ceil(*printer.resin.critical_dose_mj_cm3 / dose);
  const bool possible = dose > 0 && std::isfinite(turns);
  figures["turns_to_critical_" + of] = possible ? Json(turns) : Json(nullptr);
  figures["duration_to_critical_" + of + "_s"] =
      possible ? Json(model::seconds_of(printer.stage, turns)) : Json(nullptr);
}

}  // namespace

void TurnDoses::add(const Image& dose, const Image& target) {
  if (target.size() != 0 && target.size() != dose.size()) {
    throw Error{Fault::data, "target: " + std::to_string(target.width) + " x " + std::to_string(target.height) +
                                 " voxels, the dose " + std::to_string(dose.width) + " x " +
                                 std::to_string(dose.height)};
  }
  for (std::size_t i = 0; i < dose.size(); ++i) {
    const double value = dose.values[i];
    largest_ = std::max(largest_, value);
    sum_ += value;
    if (target.size() == 0 || model::label_of(target.values[i]) != model::Label::part) continue;
    part_least_ = part_count_ == 0 ? value : std::min(part_least_, value);
    part_sum_ += value;
    ++part_count_;
  }
  count_ += static_cast<double>(dose.size());
}

Json TurnDoses::doses(const std::string& of, bool absolute, double scale) const {
  const std::string unit = absolute ? "_mj_cm3" : "_relative";
  Json figures;
  figures["dose_" + of + "_max" + unit] = scale * largest_;
  figures["dose_" + of + "_mean" + unit] = count_ > 0 ? scale * sum_ / count_ : 0;
  if (part_count_ > 0) {
    figures["part_voxels"] = part_count_;
    figures["part_dose_" + of + "_min" + unit] = scale * part_least_;
    figures["part_dose_" + of + "_mean" + unit] = scale * part_sum_ / static_cast<double>(part_count_);
  }
  return figures;
}

Json TurnDoses::exposures(const model::Printer& printer, double scale) const {
  Json figures;
  if (part_count_ > 0) {
    add_exposure(figures, "mean", scale * part_sum_ / static_cast<double>(part_count_), printer);
    add_exposure(figures, "all", scale * part_least_, printer);
  } else {
    add_exposure(figures, "max", scale * largest_, printer);
  }
  return figures;
}

ExposurePlan plan_exposure(const model::DoseMetrics& doses, double mj_cm3, const model::Printer& printer,
                           double turns_of_frames, std::optional<double> threshold) {
  constexpr double rounding = 1e-9;  // a dose that needs 3.0000000001 turns is given 3
  const double critical = *printer.resin.critical_dose_mj_cm3;
  const double middle = mj_cm3 * verdict::window_middle(doses);
  const double aim = mj_cm3 * verdict::aimed_dose(doses, threshold);
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
  plan.turns = std::round(showings * turns_of_frames);
  plan.multiplier = std::min(1.0, critical / (aim * showings));
  plan.seconds = model::seconds_of(printer.stage, plan.turns);
  plan.peak_intensity_mw_cm2 = plan.multiplier * printer.projector.max_intensity_mw_cm2;
  return plan;
}

void append_json(Json& figures, const ExposurePlan& plan) {
  figures["turns"] = plan.turns;
  if (plan.turns == std::floor(plan.turns)) figures["turns"] = round_int(plan.turns);
  figures["duration_s"] = plan.seconds;
  figures["multiplier"] = plan.multiplier;
  figures["peak_intensity_mw_cm2"] = plan.peak_intensity_mw_cm2;
}

}  // namespace vam::score
