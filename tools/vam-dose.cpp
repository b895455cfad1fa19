// SPDX-License-Identifier: GPL-3.0-or-later
// vam-dose: simulates the dose of a print.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_fwd.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "manual_page.hpp"
#include "model/metadata.hpp"
#include "model/printer.hpp"
#include "optics/projector_frames.hpp"
#include "resin/absolute_dose.hpp"
#include "score/exposure.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"
#include "vam-dose/expose.hpp"
#include "vam-dose/light.hpp"
#include "vam-dose/options.hpp"
#include "vam-dose/place.hpp"
#include "vam-dose/shown.hpp"
#include "vam-dose/sink.hpp"
#include "verdict/verdict.hpp"

namespace vam::dose_tool {

namespace {

struct Unit {
  bool absolute = false;
  double turn = 1;         // multiplies the dose of one turn
  double showings = 1;     // and that of the whole print
  double relative = 1;     // what a relative dose of 1 becomes
  double print_turns = 0;  // of the print whose dose it is; 0: it is the dose of a turn
  std::string dose_of;     // which print: shown, stated or planned [formats: Attributes of volumes and prints]
  double full_turns = 0;   // of full intensity
  double print_s = 0;
  std::optional<score::ExposurePlan> plan;  // of --exposure-plan
};

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

/// Absolute when the resin has a critical dose, and then of the print that the light was planned for. Throws
/// Fault::data when an exposure is to be planned for a target without part or void; warns when there is no process
/// window.
Unit unit_of(const Exposed& exposed, const Options& options, const model::Printer& printer,
             const model::StackInfo& light) {
  const auto per_radian = resin::dose_per_radian_mj_cm3(printer);
  const double peak = exposed.light.peak;
  const double full_scale = options.full_scale.value_or(peak);
  Unit unit;
  unit.absolute = per_radian && full_scale > 0;
  if (unit.absolute) unit.turn = *per_radian / (options.full_scale ? 1.0 : peak);
  if (options.exposure_plan) {
    unit.dose_of = "planned";
    unit.plan = planned(exposed.metrics, unit.turn, printer, light, options);
    if (exposed.seconds > 0 && std::abs(exposed.seconds - unit.plan->seconds) > 0.01 * unit.plan->seconds) {
      warn("exposure: planned for the dose that diffuses for " + format_number(exposed.seconds, 4) + " s, it takes " +
           format_number(unit.plan->seconds, 4) + " s; --diffusion-time " + format_number(unit.plan->seconds, 4) +
           " plans for that");
    }
    unit.print_turns = unit.plan->turns;
    unit.full_turns = unit.showings = unit.plan->turns * unit.plan->multiplier;
  } else if (!options.shown.empty()) {
    unit.dose_of = "shown";
    unit.print_turns = unit.full_turns = exposed.shown_turns;
  } else if (unit.absolute) {
    const std::string name = io::input_name(options.inputs.front());
    const auto shown = session::exposure_of(name, light, printer, peak,
                                            {.full_scale = options.full_scale, .sets = options.printer.sets});
    if (shown.share) {
      session::require_dose(shown, true, name);
      const bool as_stated = light.space == model::Space::projector && light.piece.whole() && shown.as_planned();
      unit.dose_of = as_stated ? "stated" : "planned";
      unit.print_turns = shown.turns;
      unit.full_turns = shown.turns * std::min(1.0, peak / shown.full_scale);
      unit.showings = shown.turns * full_scale / shown.full_scale;
    }
  }
  unit.print_s = model::seconds_of(printer.stage, unit.print_turns);
  if (unit.absolute)
    unit.relative = *per_radian / full_scale * (options.shown.empty() ? unit.showings : unit.full_turns);
  return unit;
}

/// The volume in that unit.
void convert(io::SparseVolume& volume, const Unit& unit) {
  session::forget_exposure(volume.metadata);
  for (const char* other :
       {"vam:dose_of", "vam:full_intensity_turns", "vam:print_turns", "vam:print_s", "vam:dose_unit_mj_cm3"})
    volume.metadata.erase(other);  // of the light, or of a dose whose voxels these are like
  if (unit.absolute) {
    scale(volume, unit.turn * unit.showings);
    volume.units = "mJ/cm3";
    volume.metadata["vam:dose_unit_mj_cm3"] = format_number(unit.relative, 9);
    const auto threshold = model::threshold_dose(volume.metadata);
    if (threshold) volume.metadata["vam:threshold_dose"] = format_number(*threshold * unit.relative, 9);
  }
  if (unit.print_turns == 0) return;
  volume.metadata["vam:dose_of"] = unit.dose_of;
  volume.metadata["vam:full_intensity_turns"] = format_number(unit.full_turns, 9);
  volume.metadata["vam:print_turns"] = format_number(unit.print_turns, 9);
  volume.metadata["vam:print_s"] = format_number(unit.print_s, 9);
}

/// For --report.
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
    score::append_json(report, *unit.plan);
    report["planned_full_scale"] = options.full_scale.value_or(seen.peak) / unit.plan->multiplier;
  } else {
    report["peak_intensity_mw_cm2"] = printer.projector.max_intensity_mw_cm2;
    if (unit.print_turns > 0 && !of_run) {
      const double multiplier = unit.full_turns / unit.print_turns;
      report["turns"] = unit.print_turns;
      report["duration_s"] = unit.print_s;
      report["multiplier"] = multiplier;
      report["peak_intensity_mw_cm2"] = multiplier * printer.projector.max_intensity_mw_cm2;
    }
  }
  report["negative_fraction"] = seen.values > 0 ? seen.negative / seen.values : 0;
  if (exposed.dark_part_voxels) report["dark_part_voxels"] = *exposed.dark_part_voxels;
  if (exposed.outside) {
    const bool of_print = unit.absolute && unit.print_turns > 0 && !unit.plan;
    const double whole = unit.turn * (of_print ? unit.showings : 1.0);
    model::StrayCure outside =
        exposed.outside->at(of_print ? *printer.resin.critical_dose_mj_cm3 / whole
                                     : verdict::aimed_dose(exposed.metrics, model::threshold_dose(light.extra)));
    outside.max_dose *= whole;
    append_json(report, outside);
  }
  report["blur_sigma_mm"] = exposed.blur_mm;
  report["absorption_per_mm"] = printer.resin.absorption_per_mm;
  // [CAL19]: at given power, exposure is shortest when light falls to 1/e over the radius.
  report["absorption_for_shortest_print_per_mm"] = 1 / model::resin_radius_mm(printer.vial);
  return report;
}

}  // namespace

}  // namespace vam::dose_tool

namespace {

using namespace vam;
using dose_tool::Options;

/// Options -> light and voxels -> doses of a turn, slice by slice -> one unit for all -> volume and report.
void run(const cli::App& app, Options& options) {
  options.printer = printer_of(options);
  if (session::print_printer(options.printer, options.output)) return;
  take_sinogram(app, options);

  io::StackReader in(options.inputs.front());
  io::require(options.inputs.front(), in.info(), model::Kind::sinogram);
  const std::string name = io::input_name(options.inputs.front());
  const bool printed = !options.shown.empty();  // a print has settings of its own
  const model::Printer printer =
      session::printer_of(options.printer, printed ? model::Metadata{} : in.info().extra, name);
  session::require_settings(app, printer);
  options.alignment.angle_offset_rad = options.angle_offset_deg * rad_per_deg;
  take_full_scale(options);
  const session::Exposure stated = session::exposure_of(name, in.info(), printer, 0);
  const bool anew = options.exposure_plan && stated.planned;
  if (!options.full_scale && !anew && stated.full_scale > 0) options.full_scale = stated.full_scale;
  const model::StackInfo info = posed(app, in.info(), options);
  const dose_tool::Place place = place_of(options, printer, info);
  io::SparseVolume volume = empty_volume(app, place, printer, info, options);
  dose_tool::Light light(in, info, options, printer, stated.planned && !anew ? stated.turns : 1);
  const dose_tool::Exposed exposed = expose(light, info, options, printer, place, volume);

  const dose_tool::Unit unit = dose_tool::unit_of(exposed, options, printer, info);
  convert(volume, unit);
  io::write_volume(options.output, volume);
  io::write_report(options.report, "vam-dose", figures(exposed, unit, options, printer, info));
}

}  // namespace

int main(int argc, char** argv) {
  // Images of rows come and go among slabs that stay: each in pages of its own, or the gaps count as memory in use.
  mallopt(M_MMAP_THRESHOLD, 1 << 18);
  cli::App app({"vam-dose", "simulate the dose that a print delivers to the resin", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
