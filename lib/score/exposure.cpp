// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/json.hpp"
#include "model/dose/dose_metrics.hpp"

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

}  // namespace vam::score
