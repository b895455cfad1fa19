// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-plan/options.hpp"

#include "base/text.hpp"
#include "solid/voxel/size_doubt.hpp"
#include "vam-plan/plan.hpp"

namespace vam::plan_tool {

cli::Manual manual() {
  return {
      "vam-plan",
      "estimate within seconds whether and how a part can be printed",
      {"vam-plan reads a mesh and answers, before anything is sliced: does the part fit into what the printer can "
       "write, and if not, at which scale; how many slices it has; how thick its thinnest walls are; how much an "
       "index-matching bath would help; whether it will print, how long that takes, and how wide the process window "
       "remains if the printer deviates from its settings. If the part does not fit, all that follows is of the part "
       "at the scale that fits.",
       "Whether it prints is estimated on voxels of " + std::to_string(usual_coarseness) + " pixels, with " +
           std::to_string(optimize::PreviewTask{}.angles) + " angles and " +
           std::to_string(optimize::PreviewTask{}.iterations) +
           " iterations of the default method of vam-optimize; voxels are larger by a power of 2 where the part has "
           "more than " +
           std::to_string(most_estimated) +
           " million of them, and smaller, down to a pixel, where walls or gaps are too thin for them and smaller ones "
           "are at most " +
           format_number(most_finer) +
           " million, or where the print of the estimate is torn. What is too thin even then "
           "is stated with its volume and heights as not judged; if it is 2 % of "
           "the part or more, or if the printer's pixels lose walls or gaps or leave them in doubt, as vam-slice "
           "tells, or where a wall or another place is below 2 pixels, or a wall of a mesh below 2.3, so that it may "
           "be pierced, or if the print of the estimate is torn: in other pieces than the part, with cut walls, shut "
           "gaps or holes, as vam-score counts them, the answer is perhaps. The deviations, one at a time and "
           "either "
           "way, are " +
           deviations +
           " (as in --robust of vam-optimize): the smaller process window of the two is stated, as a fraction of the "
           "largest dose. Windows at the printer's resolution differ, of most parts they are wider. vam-optimize has "
           "the last word.",
       "Walls and gaps that are lost at the printer's pixels, or in doubt, cause a warning, as in vam-slice, for parts "
       "of up to 16 million voxels.",
       "The duration requires resin.critical_dose_mj_cm3 and resin.absorption_per_mm."},
      {{"A built-in shape in the default printer:", "vam-plan --shape gyroid:diameter=10,cell=5"},
       {"The figures for a script:", "vam-plan --shape disc-grid --report plan.json >plan.txt"}},
      {"Memory: the part at up to 16 million voxels, 21 bytes each, and the doses and projections of the estimate.",
       "Wall thickness: the first percentile of the distance across the part at its medial surface, accurate to one "
       "or two voxels, which are larger for parts of more than 16 million voxels. Faces that converge by more than 20 "
       "degrees, as at the edge of a wedge, are no walls, and reported as sharp edges; a strut, the neck "
       "of an hourglass, or another place that is thinner by more than 1.5 voxels, is "
       "stated with its coordinates in the print, as placed in the vial; of a part without walls, such "
       "as a cone, the largest ball within is stated."},
      {"vam-slice", "vam-optimize", "vam-score"}};
}

void declare(cli::App& app, Options& options) {
  app.positional("PART", options.input, "Mesh: STL, OBJ, PLY, OFF or 3MF.").reads({"--shape"});
  app.option("--shape", "NAME:KEY=VALUE,...", options.shape, "Built-in shape instead of a file, as in vam-slice.")
      .form();
  app.group("Placement");
  app.choice("--unit", options.unit, solid::unit_names(), "Unit of the file's coordinates.");
  app.choice("--up", options.up, {"x", "y", "z", "-x", "-y", "-z"}, "Axis of the file that points upwards.");
  app.option("--scale", "FACTOR", options.scale, cli::positive, "Scale factor.");
  app.group("Output and performance");
  app.flag("--no-preview", options.no_preview, "Omit the estimate of the print.");
  cli::add_report(app, options.report);
  cli::add_printer(app, options.printer);
  cli::add_threads(app);
  app.usual({"--shape", "--unit", "--up", "--scale", "--no-preview", "--report", "--printer", "--set"});
}

}  // namespace vam::plan_tool
