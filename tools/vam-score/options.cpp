#include "vam-score/options.hpp"

namespace vam::score_tool {

void declare(cli::App& app, Options& options) {
  app.positional("DOSE", options.input, "Volume (VDB) with the dose.").reads();
  app.option("--grid", "NAME", options.grid, "Grid to score; 'scatter' is a reconstruction of vam-ost.");
  app.option("--target", "FILE", options.target, "Volume with the grid 'target', of the same size and place.").reads();
  app.default_is("the grid 'target' of DOSE");
  app.option("--sinogram", "FILE", options.sinogram, "Projections (EXR), for the light efficiency.").reads();
  app.group("Score");
  app.option(
      "--require", "CONDITIONS", options.require,
      "Exit with status 1 unless all conditions hold, e.g. 'ver<=0.01,pw>=0'. The names are those of the table.");
  app.option("--critical-dose", "DOSE", options.how.threshold, cli::positive,
             "Also score the print at this threshold.");
  app.default_is("resin.critical_dose_mj_cm3 if the dose is in mJ/cm3");
  app.option("--trim", "ALPHA", options.how.trim, {0, 0.999}, "Fraction trimmed from both tails together.");
  app.flag("--surface", options.how.surface, "Score surface voxels, too: as part when at least half covered.");
  app.flag("--absolute", options.how.absolute, "PW and IPDR in units of the dose.");
  app.option("--reach", "FILE", options.reach,
             "Write a volume (OpenVDB grid reach): the fraction of stage angles from which each voxel is lit.")
      .writes();
  app.group("Print");
  app.option("--mesh", "FILE", options.print, "Write the print as PLY, in mm.").was("--print").writes();
  app.choice("--ply-as", options.print_as, {"mesh", "points"}, "Its surface, or its voxels coloured by dose.")
      .needs({"--mesh"})
      .was("--print-as");
  app.option("--isovalue", "DOSE", options.print_at, cli::positive, "Threshold of the print.")
      .needs({"--mesh"})
      .was("--print-at");
  app.default_is("the critical dose, else the threshold that the projections were optimised for, or the best one");
  cli::add_printer(app, options.printer);
  app.group("Output and performance");
  app.flag("--json", options.json, "Print JSON instead of the table.");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

}  // namespace vam::score_tool
