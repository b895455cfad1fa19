// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate critical-dose: the dose with which the resin gels at the surface of a print.
#include <cmath>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/common.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/file_type.hpp"
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

struct CriticalDoseOptions {
  std::string print;
  std::string dose;
  std::string design;  // none: only the dose at the print's surface
  std::optional<double> turns;
  std::string record = "-";
  std::optional<double> isovalue;
  cli::PrinterOptions printer;
};

void declare(cli::App& app, CriticalDoseOptions& options) {
  app.positional(
         "PRINT", options.print,
         "Mesh of the print in the part's frame (vam-ost --mesh, vam-sdf -o), or a volume (VDB) with --isovalue.")
      .reads();
  app.option("--dose", "FILE.vdb", options.dose,
             "Dose in mJ/cm3 that the print was given (vam-dose --shown), or that of a turn or a plan.")
      .reads()
      .required();
  app.option("--turns", "N", options.turns, cli::positive,
             "Turns that the print took, where the dose is that of one, at full intensity, or of a plan, at its own.")
      .default_is("required but for a dose by --shown")
      .not_for({"doses by --shown"});
  app.option(
         "--design", "FILE", options.design,
         "Mesh of the design in the part's frame, or volume of vam-slice: also find the critical dose that makes the "
         "next print as large as the design.")
      .reads()
      .only_with({"resin.critical_dose_mj_cm3"});
  app.option("-o,--output", "FILE.json", options.record, "Report; - is standard output.");
  app.option("--isovalue", "VALUE", options.isovalue, cli::positive, "Value of the volume at the print's surface.")
      .default_is("required for a volume")
      .not_for({"meshes"});
  cli::add_printer(app, options.printer);
}

void run(const cli::App& app, CriticalDoseOptions& options) {
  if (!io::is_volume(options.print)) app.require_for("meshes", options.print);
  const io::SparseVolume sparse = session::read_dose(options.dose);
  const model::Printer printer = session::printer_of(options.printer, sparse.metadata, options.dose);
  const bool shown = model::stated_text(sparse.metadata, "vam:dose_of") == "shown";
  if (shown) app.require_for("doses by --shown", options.dose);
  if (!shown && !options.turns)
    throw Error{Fault::data, options.dose + ": is of no print that was made (vam-dose --shown); give its --turns"};
  session::require_settings(app, printer);
  const double turns =
      shown ? 1 : *options.turns / model::stated_number(sparse.metadata, "vam:print_turns").value_or(1);
  model::Volume dose = io::dense_volume(sparse);
  for (float& value : dose.values) value *= static_cast<float>(turns);
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

}  // namespace

void add_critical_dose(cli::App& app) {
  app.subcommand<CriticalDoseOptions>("critical-dose", "dose with which the resin gels at the surface of a print",
                                      declare, run);
}

}  // namespace vam::calibrate_tool
