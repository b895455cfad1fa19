// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-score/options.hpp"

#include "io/mesh/file.hpp"

namespace vam::score_tool {

namespace {

void declare_print(cli::App& app, Options& options) {
  app.group("Print");
  app.option("--mesh", "FILE", options.print,
             "Write the print in mm, as PLY, STL, OBJ or 3MF by the ending of the name.")
      .writes_as(io::written_mesh_endings());
  app.choice("--ply-as", options.print_as, {"mesh", "points"},
             "Content of FILE: the surface of the print, or as PLY its voxels coloured by dose.")
      .only_with({"--mesh .ply"});
  app.option("--isovalue", "DOSE", options.print_at, cli::positive, "Threshold dose of the print's surface.")
      .only_with({"--mesh"});
  app.default_is(
      "the critical dose, else the threshold for which the projections were optimised, else the best threshold");
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("DOSE ...", options.inputs, "Volume (VDB) with the dose; several with --table.").reads();
  app.option("--grid", "NAME", options.grid, "Grid to score; 'scatter' is a reconstruction of vam-ost.");
  app.option("--target", "FILE", options.target, "Volume with the grid 'target', of the same size and position.")
      .reads();
  app.default_is("the grid 'target' of DOSE");
  app.option("--sinogram", "FILE", options.sinogram, "Projections (EXR), for the light efficiency.").reads();
  app.group("Score");
  app.option(
      "--require", "CONDITIONS", options.require,
      "Exit with status 1 unless all conditions hold, e.g. 'ver<=0.01,pw>=0'. The names are those of the table.");
  app.option("--critical-dose", "DOSE", options.how.threshold, cli::positive,
             "Threshold of the print, in the unit of the dose, in place of what the dose states.");
  app.default_is("as given by resin.critical_dose_mj_cm3 and the exposure, if the dose is in mJ/cm3");
  app.option("--trim", "ALPHA", options.how.trim, {0, 0.999}, "Fraction of voxels trimmed, both tails together.");
  app.flag("--surface", options.how.surface,
           "Score surface voxels, too: as part if at least half covered, else as void.");
  app.flag("--absolute", options.how.absolute, "State PW and IPDR in the unit of the dose.");
  app.option("--lit-fraction", "FILE", options.lit_fraction,
             "Write a volume (grid lit_fraction): the fraction of stage angles from which each voxel is lit.")
      .writes_as({".vdb"});
  session::add_grey_target(
      app, options.grey,
      {"--critical-dose", "--trim", "--surface", "--absolute", "--sinogram", "--mesh", "--lit-fraction"});
  declare_print(app, options);
  cli::add_printer(app, options.printer);
  app.group("Output and performance");
  app.option("--report", "FILE", options.report,
             "Write a report in JSON; its keys carry the units. - prints it on standard output instead of the table.")
      .not_in_job()
      .writes();
  app.choice("--table", options.table, {"text", "csv", "markdown", "latex"},
             "Form of the table: text, with the meaning of each figure and the verdict, or figures alone, a column for "
             "each DOSE.");
  for (const char* form : {"csv", "markdown", "latex"})
    app.excludes({"--report", "--mesh", "--lit-fraction", "--grey-target"}, form);
  cli::add_threads(app);
  app.usual({"--grid", "--target", "--sinogram", "--require", "--critical-dose", "--surface", "--grey-target", "--mesh",
             "--printer", "--set", "--report", "--table"});
}

}  // namespace vam::score_tool
