// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-plan/options.hpp"

#include "solid/voxel/size_doubt.hpp"
#include "vam-plan/plan.hpp"

namespace vam::plan_tool {

void declare(cli::App& app, Options& options) {
  app.positional("PART", options.input, "Mesh: STL, OBJ, PLY, OFF or 3MF.").reads({"--shape"});
  app.option("--shape", "NAME:KEY=VALUE,...", options.shape, "Built-in shape instead of a file, as in vam-slice.")
      .form();
  app.group("Placement");
  app.choice("--unit", options.unit, solid::unit_names(), "Unit of the file's coordinates.");
  app.choice("--up", options.up, {"x", "y", "z", "-x", "-y", "-z"}, "Axis of the file that points upwards.");
  app.option("--scale", "FACTOR", options.scale, cli::positive, "Scale factor.");
  session::add_array(app, options.array, {}, {"--shape"});
  app.group("Output and performance");
  app.option(
      "--voxel", "MM", options.voxel_mm, cli::positive,
      "Size of the voxels, as in vam-slice, and of those of the estimate, however long it takes. Default: a pixel "
      "of the projector, and as much larger in the estimate as takes seconds.");
  app.flag("--no-preview", options.no_preview, "Omit the estimate of the print.");
  app.option(
      "--require", "CONDITIONS", options.require,
      "Exit with status 1 unless all conditions hold, e.g. 'prints>=1,duration_s<=120', on numbers of the report.");
  cli::add_report(app, options.report);
  cli::add_printer(app, options.printer);
  app.flag("--printers", options.printers,
           "List the presets that --printer takes instead of a file: printers, vials and resins, each value with its "
           "source, and exit.");
  cli::add_threads(app);
  app.usual({"--shape", "--unit", "--up", "--scale", "--voxel", "--no-preview", "--require", "--report", "--printer",
             "--set"});
}

}  // namespace vam::plan_tool
