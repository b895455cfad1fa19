// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/unit.hpp"

#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/metadata.hpp"
#include "optics/projector_frames.hpp"
#include "resin/absolute_dose.hpp"
#include "score/exposure.hpp"
#include "vam-dose/sink.hpp"

namespace vam::dose_tool {

namespace {

score::ExposurePlan planned(const model::DoseMetrics& doses, double scale, const model::Printer& printer,
                            const model::StackInfo& light, const Options& options) {
  if (doses.part == 0 || doses.void_ == 0) {
    throw Error{Fault::data, options.like + ": its target has " + std::to_string(doses.part) + " part voxels and " +
                                 std::to_string(doses.void_) + " void voxels; --exposure-plan requires both"};
  }
  if (doses.min_part <= doses.max_void) {
    warn("exposure: the void receives up to " + format_number(scale * doses.max_void, 4) +
         " mJ/cm3 per turn, the part at least " + format_number(scale * doses.min_part, 4) +
         "; there is no process window, and the plan is for the best threshold");
  }
  return score::plan_exposure(doses, scale, printer, optics::turns_of(light), model::threshold_dose(light.extra));
}

}  // namespace

Unit unit_of(const Exposed& exposed, const Options& options, const model::Printer& printer,
             const model::StackInfo& light) {
  const auto per_radian = resin::dose_per_radian_mj_cm3(printer);
  const double full = options.full_scale ? 1.0 : exposed.light.peak;
  Unit unit{per_radian.has_value(),
            per_radian && full > 0 ? *per_radian / full : 1.0,
            exposed.shown_turns,
            model::seconds_of(printer.stage, exposed.shown_turns),
            {}};
  if (options.exposure_plan) unit.plan = planned(exposed.metrics, unit.turn, printer, light, options);
  return unit;
}

void convert(io::SparseVolume& volume, const Unit& unit) {
  const bool of_run = unit.shown_turns > 0;
  const double turns = unit.plan ? unit.plan->turns * unit.plan->multiplier : of_run ? unit.shown_turns : 1.0;
  if (unit.absolute) {
    scale(volume, unit.turn * (of_run ? 1.0 : turns));  // that of a run is of its turns already
    volume.units = "mJ/cm3";
    volume.metadata["vam:dose_unit_mj_cm3"] = format_number(unit.turn * turns, 9);
    const auto threshold = model::threshold_dose(volume.metadata);
    if (threshold) volume.metadata["vam:threshold_dose"] = format_number(*threshold * unit.turn * turns, 9);
  }
  if (!unit.plan && !of_run) return;
  volume.metadata["vam:full_intensity_turns"] = format_number(turns, 9);
  volume.metadata["vam:print_turns"] = format_number(unit.plan ? unit.plan->turns : unit.shown_turns, 9);
  volume.metadata["vam:print_s"] = format_number(unit.plan ? unit.plan->seconds : unit.shown_s, 9);
}

Json figures(const Exposed& exposed, const Unit& unit, const Options& options, const model::Printer& printer,
             const model::StackInfo& light) {
  const light::LightSeen& seen = exposed.light;
  const bool of_run = !options.shown.empty();
  Json report = exposed.doses.doses(of_run ? "shown" : "per_turn", unit.absolute, unit.turn);
  if (of_run) report["shown_turns"] = exposed.shown_turns;
  if (unit.absolute) report["critical_dose_mj_cm3"] = *printer.resin.critical_dose_mj_cm3;
  if (unit.absolute && !of_run) report.update(exposed.doses.exposures(printer, unit.turn));
  report["model"] = light.space != model::Space::projector ? "parallel"
                    : exposed.climbs                       ? "chief rays"
                                                           : "level chief rays";
  report["poses"] = light.poses.size();
  report["full_scale"] = options.full_scale.value_or(seen.peak);
  report["efficiency"] = seen.efficiency.value();
  if (unit.plan) {
    score::add_to(report, *unit.plan);
    report["planned_full_scale"] = options.full_scale.value_or(seen.peak) / unit.plan->multiplier;
  } else {
    report["peak_intensity_mw_cm2"] = printer.projector.max_intensity_mw_cm2;
  }
  report["negative_fraction"] = seen.values > 0 ? seen.negative / seen.values : 0;
  if (exposed.dark_part_voxels) report["dark_part_voxels"] = *exposed.dark_part_voxels;
  if (exposed.outside) {
    const bool of_print = of_run && unit.absolute;
    model::Outside outside =
        exposed.outside->at(of_print ? *printer.resin.critical_dose_mj_cm3 / unit.turn
                                     : score::aimed_dose(exposed.metrics, model::threshold_dose(light.extra)));
    outside.max_dose *= unit.turn;
    add_to(report, outside);
  }
  report["blur_sigma_mm"] = exposed.blur_mm;
  report["absorption_per_mm"] = printer.resin.absorption_per_mm;
  // [CAL19]: at given power, exposure is shortest when light falls to 1/e over the radius.
  report["absorption_for_shortest_print_per_mm"] = 1 / model::resin_radius_mm(printer.vial);
  return report;
}

}  // namespace vam::dose_tool
