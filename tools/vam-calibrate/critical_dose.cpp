// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate critical-dose: the dose with which the resin gels at the surface of a print.
#include <cmath>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/report.hpp"
#include "metrology/compare/surface_dose.hpp"
#include "model/metadata.hpp"
#include "session/printer.hpp"
#include "session/surface.hpp"
#include "session/volumes.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr double design_isovalue = 0.5;  // of coverage
constexpr double most_spread = 0.2;      // of the dose

}  // namespace

void measure_critical_dose(const cli::App& app, const CriticalDoseOptions& options) {
  const io::SparseVolume sparse = session::read_dose(options.dose);
  const model::Printer printer = session::printer_of(options.printer, sparse.metadata, options.dose);
  const bool total = model::stated_number(sparse.metadata, "vam:full_intensity_turns").has_value();
  if (!total && !options.turns) {
    throw Error{Fault::data,
                options.dose +
                    ": does not state vam:full_intensity_turns, so that its dose is that of one turn; give "
                    "that of the print, by vam-dose --shown or --exposure-plan, or --turns"};
  }
  session::require_settings(app, printer);
  if (total) app.require_for("doses that state their turns", options.dose);
  model::Volume dose = io::dense_volume(sparse);
  for (float& value : dose.values) value *= static_cast<float>(options.turns.value_or(1));
  const double stretch_z = model::stretch_z(sparse.metadata);
  const auto at_print =
      metrology::surface_dose(print_surface(options.print, options.isovalue), dose, stretch_z, options.print);
  Json figures = metrology::to_json(at_print);
  const double middle = at_print.critical_dose_mj_cm3.value;
  if (!options.design.empty()) {
    const auto at_design = metrology::surface_dose(session::read_surface(options.design, design_isovalue), dose,
                                                   stretch_z, options.design);
    const double designed = at_design.critical_dose_mj_cm3.value;
    figures["design_dose_mj_cm3"] = designed;
    figures["next_critical_dose_mj_cm3"] = *printer.resin.critical_dose_mj_cm3 + middle - designed;
    figures["next_critical_dose_sigma_mj_cm3"] =
        std::hypot(at_print.critical_dose_mj_cm3.sigma, at_design.critical_dose_mj_cm3.sigma);
  }
  io::write_report(options.record, "vam-critical-dose", figures);
  if (!(middle > 0 && at_print.spread_mj_cm3 <= most_spread * middle)) {
    throw Error{Fault::judged, "the dose at the print's surface varies by " + format_number(at_print.spread_mj_cm3, 3) +
                                   " of " + format_number(middle, 3) +
                                   " mJ/cm3, so that it is no surface of this dose; check how the print is aligned"};
  }
}

}  // namespace vam::calibrate_tool
