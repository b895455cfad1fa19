// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sdf: deviation of a print from its design.
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/mesh/file.hpp"
#include "manual_page.hpp"
#include "plot/save.hpp"
#include "vam-sdf/options.hpp"

namespace {

using namespace vam;
using sdf_tool::HeightOptions;
using sdf_tool::Options;
using sdf_tool::TrendOptions;

void declare_inspection(cli::App& app, Options& options) {
  app.group("Regions and uncertainty");
  app.option(
      "--region", "NAME=KIND:X0,Y0,Z0,X1,Y1,Z1|FILE", options.regions,
      "Also measure the part of the design's surface within this box, in mm of the design, or on the faces of this "
      "mesh, e.g. those that a CAD program exports of a seat: what is within 0.5 % of the design's largest dimension "
      "of them and faces the same way. KIND is surface (rms, mean, max, within), or, beside these, plane (flatness, "
      "tilt, offset), cylinder (diameter, cylindricity, "
      "tilt, offset) or wall (thickness, min_thickness).");
  app.option("--datum", "NAME", options.datum,
             "Align by three regions that are planes: the first fixes its plane, the second its direction about the "
             "first one's normal, the third the remaining shift. Given three times, primary first.");
  app.option("--uncertainty", "FILE.vdb", options.uncertainty,
             "Standard deviations of the print volume's values, from vam-ost --uncertainty.")
      .reads()
      .not_for({"meshes"});
  app.option("--isovalue-uncertainty", "VALUE", options.isovalue_uncertainty, cli::non_negative,
             "Standard uncertainty of the isovalue, in its units.")
      .not_for({"meshes"});
  app.option("--scale-uncertainty", "PERCENT", options.scale_uncertainty_percent, cli::non_negative,
             "Standard uncertainty of the print's scale, that of the camera's pixel pitch.");
}

void declare(cli::App& app, Options& options) {
  app.positional("PRINT", options.print, "Mesh (" + io::mesh_format_names() + ") or volume (.vdb).").reads();
  app.positional("DESIGN", options.design, "Mesh or volume of the design.").reads();
  app.option("-o,--output", "FILE.ply", options.output,
             "Write the aligned print with distances and colours at its vertices.")
      .writes({".ply"});
  app.option("--volume", "FILE.vdb", options.volume,
             "Write how far the print is outside the design, in mm around the design's surface, for vam-slice "
             "--compensate.")
      .writes({".vdb"})
      .excludes({"--fit-scale"});
  app.option("--volume-voxel", "MM", options.volume_voxel_mm, cli::positive, "Voxel of --volume.")
      .default_is("1/100 of the design's largest dimension")
      .only_with({"--volume"});
  app.option("--isovalue", "VALUE", options.isovalue, cli::any, "Isovalue of a print volume's surface, in its units.")
      .excludes({"--resin"})
      .not_for({"meshes"});
  app.option("--resin", "FILE", options.resin_record,
             "Record of vam-calibrate resin with the gelation threshold I_p, used as isovalue.")
      .reads()
      .not_for({"meshes"});
  app.option("--design-isovalue", "VALUE", options.design_isovalue, cli::any, "Isovalue of a design volume's surface.")
      .not_for({"mesh designs"});
  app.option("--min-body", "MM3", options.pieces_mm3, cli::non_negative,
             "Minimum volume of a body that belongs to the print; smaller bodies of a print volume are dropped.")
      .default_is("1 % of the largest body's volume")
      .not_for({"meshes"});
  app.group("Alignment");
  app.choice("--align", options.align, {"none", "icp", "full"}, "Alignment of the print with the design.");
  app.flag("--fit-scale", options.scale, "Also fit a uniform scale.");
  app.group("Figures");
  app.option("--samples", "N", options.samples, {1000, 1e8}, "Number of points on each surface.");
  app.option("--histogram", "FILE", options.histogram,
             "Histogram of the distances by area: a plot (.png, .pdf or .svg), else CSV.");
  app.option("--bins", "N", options.bins, {2, 10000}, "Number of histogram bins.");
  app.option("--limit", "MM", options.limit_mm, cli::positive,
             "Limit of the histogram and of the colours, on either side of 0.")
      .default_is("the 99th percentile");
  app.option(
      "--require", "CONDITIONS", options.require,
      "Exit with status 1 unless all conditions hold, on rms, trimmed (RMS of the 95 % nearest to the design), "
      "mean, sigma, mad, max, hausdorff (mm), rms_percent and within (% of the surface within --tolerance), and on "
      "those of regions, e.g. 'rms<=0.2,top.flatness<0.05'.");
  app.flag("--guard-band", options.guard_band,
           "Conditions of --require must hold for all values within the expanded uncertainty (ISO 14253-1).")
      .only_with({"--require"});
  app.option(
      "--tolerance", "[NAME=]MM", options.tolerances,
      "Report the fraction of the print's surface within this distance of the design, more than 0; with NAME, of that "
      "region, "
      "which otherwise has the tolerance of the whole print.");
  cli::add_report(app, options.report);
  declare_inspection(app, options);
  cli::add_threads(app);
  app.usual({"--output", "--volume", "--isovalue", "--align", "--histogram", "--require", "--tolerance", "--report",
             "--region", "--datum", "--uncertainty"});
}

void declare_height(cli::App& app, HeightOptions& options) {
  app.positional("IMAGE", options.image,
                 "Height image of a profilometer (PNG, TIFF or EXR), or a mesh or volume, viewed from above.")
      .reads();
  app.positional("DESIGN", options.design, "Mesh or volume of the design, embossed side up.").reads();
  app.option("--pixel", "MM", options.pixel_mm, cli::positive, "Pixel pitch of the image.");
  app.option(
      "--full-scale-height", "MM", options.full_mm, cli::positive,
      "Height at full scale of a PNG or TIFF, in which 0 is a missing reading. EXR values are multiplied by it.");
  app.option("--min-height", "MM", options.lowest_mm, cli::any, "Exclude heights below MM (the substrate).");
  app.option("--design-isovalue", "VALUE", options.design_isovalue, cli::any, "Isovalue of a design volume's surface.");
  app.choice("--align", options.align, {"none", "icp", "full"},
             "Alignment of the design with the print: centred (none), refined from there (icp), or from any "
             "orientation (full).");
  app.option("-o,--output", "FILE", options.output,
             "Write the levelled heights with the design's outline (.png, .pdf or .svg).")
      .writes(plot::figure_endings());
  app.option("--line", "X0,Y0,X1,Y1", options.line, 4, "End points of a section, in pixels from the top left corner.")
      .default_is("the middle column");
  app.option("--plot", "FILE", options.plot, "Plot the heights along the section (.png, .pdf or .svg).")
      .writes(plot::figure_endings());
  app.option("--require", "CONDITIONS", options.require,
             "Exit with status 1 unless all conditions hold, on rms and max (mm), iou, shrinkage (%) and height (mm).");
  cli::add_report(app, options.report);
}

void declare_trend(cli::App& app, TrendOptions& options) {
  app.positional("RUN ...", options.runs,
                 "Reports of vam-sdf (--report), or folders that hold one, in the order of the prints.")
      .reads();
  app.option("--figure", "NAME", options.figure, "Figure of --plot.").only_with({"--plot"});
  app.option("--plot", "FILE", options.plot,
             "Plot the figure and its uncertainties over the prints (.png, .pdf or .svg).")
      .writes(plot::figure_endings());
  cli::add_report(app, options.report);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-sdf", "measure the deviation of a print from its design", manual_page});
  Options options;
  HeightOptions height;
  TrendOptions trend;
  declare(app, options);
  declare_height(app.subcommand("height", "compare a profilometer's height image of an embossed print with its design",
                                [&] { sdf_tool::height(height); }),
                 height);
  declare_trend(app.subcommand("trend", "compare repeated prints: mean, spread and drift of every figure",
                               [&] { sdf_tool::trend(trend); }),
                trend);
  return app.run(argc, argv, [&] { sdf_tool::deviation(app, options); });
}
