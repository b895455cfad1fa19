#include "vam-score/options.hpp"

namespace vam::score_tool {

void declare(cli::App& app, Options& options) {
  app.positional("DOSE", options.input, "Volume (VDB) with the dose.");
  app.option("--grid", "NAME", options.grid, "The grid to judge; 'scatter' judges what a camera saw.");
  app.option("--target", "FILE", options.target,
             "Volume with the grid 'target' of the same size and place. Without it the target in DOSE.");
  app.option("--sinogram", "FILE", options.sinogram, "The projections (EXR), for the efficiency of light.");
  app.group("Judgement");
  app.option("--require", "CONDITIONS", options.require,
             "Exit with 1 unless all hold, e.g. 'ver<=0.01,pw>=0'. The names are those of the table.");
  app.option("--critical-dose", "DOSE", options.how.threshold, cli::positive,
             "Also judge the print at this threshold. Without it resin.critical_dose_mj_cm3 if the dose is in mJ/cm3.");
  app.option("--trim", "ALPHA", options.how.trim, {0, 0.999}, "Fraction trimmed off both ends together.");
  app.flag("--surface", options.how.surface, "Judge surface voxels too: part when at least half covered.");
  app.flag("--absolute", options.how.absolute, "PW and IPDR in the dose's unit.");
  app.group("The print");
  app.option("--print", "FILE", options.print, "Write what prints as PLY, in mm.");
  app.choice("--print-as", options.print_as, {"mesh", "points"}, "Its surface, or its voxels coloured by dose.");
  app.option("--print-at", "DOSE", options.print_at, cli::positive,
             "Threshold of the print. Without it the critical dose, else the best threshold.");
  cli::add_printer(app, options.printer);
  app.group("Output and machine");
  app.flag("--json", options.json, "Print JSON instead of the table.");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

}  // namespace vam::score_tool
