// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sdf: deviation of a print from its design.
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/mesh/file.hpp"
#include "plot/save.hpp"
#include "vam-sdf/options.hpp"

namespace {

using namespace vam;
using sdf_tool::HeightOptions;
using sdf_tool::Options;
using sdf_tool::TrendOptions;

cli::Manual manual() {
  return {
      "vam-sdf",
      "measure the deviation of a print from its design",
      {"vam-sdf reads the print (a mesh, or a volume whose isosurface at --isovalue is used) and the design (a "
       "mesh, or a target volume), aligns them, and measures signed distances: positive where the print is outside "
       "the design, the convention of MeshLab, CloudCompare and Open3D. Statistics are computed from points "
       "distributed evenly over the area, in both directions: from the print to the design, and from the design to "
       "the print, which alone reveals missing pieces.",
       "A volume is read in its own coordinate system; the stretch in z applied by vam-slice is removed, so that a "
       "simulated dose can be compared with the original mesh.",
       "--align full needs no initial pose: centroids and principal axes determine it, every symmetric variant is "
       "tried, and point-to-plane ICP refines it. --align icp refines the pose of the files; --align none keeps "
       "it. A print that covers less than 6/7 of the design is taken for a part of it: poses all over the design are "
       "tried, fracture faces are given no weight, and if two poses that no symmetry relates fit equally well, the "
       "status is 65. With --fit-scale a uniform scale is also fitted and reported as shrinkage; all other figures, "
       "the "
       "shrinkage along the axes (shrinkage_xyz_percent) too, are then of the scaled print.",
       "A summary is printed on standard error if that is a terminal; --report writes the figures as JSON, -o the "
       "print with distances and blue-white-red colours. With --require the exit status is 1 unless all conditions "
       "hold.",
       "Every figure has an expanded uncertainty (coverage factor 2), determined by 20 Monte Carlo trials (JCGM 101) "
       "in "
       "which the surface is disturbed, the pose follows, and a quarter of the points is measured. It contains the "
       "noise of the surface, from --uncertainty or a mesh of vam-ost --uncertainty, otherwise from the differences "
       "between neighbouring vertices; the pose, which depends on it; the choice of points; --isovalue-uncertainty; "
       "--scale-uncertainty; and, of volumes and meshes of vam-ost --uncertainty, their resolution: 0.04 voxels, the "
       "same all over the print, which covers diameters from 12 voxels on. It does not contain what is common to the "
       "whole print and not stated by these "
       "options: "
       "refractive indices, absorption, run-out that remains, errors of the design.",
       "--region measures faces, bores and walls. Planes and cylinders are fitted by least squares; flatness and "
       "cylindricity are the ranges of the departures from them, which noise and rounded edges in the box increase. "
       "The thickness of a wall is "
       "that "
       "of the largest ball inside the design plus the distances of the print on both sides.",
       "vam-sdf height compares a profilometer's height image of an embossed print with its design: the image is "
       "levelled by the plane through its base, the outline of the design at half height is aligned with that of "
       "the print, with a uniform scale reported as shrinkage, and outline, overlap and height are compared.",
       "vam-sdf trend prints, as CSV, the mean, the spread (standard deviation) and the drift per print of every "
       "figure "
       "that all reports have, with the probability of such a drift by chance (Student's t): a process drifts where "
       "drift_p is below 0.05, and varies where spread exceeds half the uncertainty."},
      {{"Compare two boxes of slightly different size:",
        "vam-slice --shape box:x=6,y=6,z=6 --voxel 0.2 --stretch-z 1 -o design.vdb\nvam-slice --shape "
        "box:x=6.2,y=6.2,z=6.2 "
        "--voxel 0.2 --stretch-z 1 -o print.vdb\nvam-sdf print.vdb design.vdb --isovalue 0.5 -o deviation.ply --report "
        "deviation.json"},
       {"Check a tolerance in a script:",
        "vam-slice --shape box:x=6,y=6,z=6 --voxel 0.2 --stretch-z 1 -o design.vdb\n"
        "vam-slice --shape box:x=6.2,y=6.2,z=6.2 --voxel 0.2 --stretch-z 1 -o print.vdb\n"
        "vam-sdf print.vdb design.vdb --isovalue 0.5 --require 'rms<=0.2' --histogram sdf.csv"},
       {"Measure the flatness of the upper face of a plate and its thickness, with uncertainties:",
        "vam-slice --shape box:x=6,y=6,z=2 --voxel 0.2 --stretch-z 1 -o design.vdb\n"
        "vam-slice --shape box:x=6.2,y=6.2,z=2.2 --voxel 0.2 --stretch-z 1 -o print.vdb\n"
        "vam-sdf print.vdb design.vdb --isovalue 0.5 --region top=plane:-2,-2,0.9,2,2,1.3 --region "
        "body=wall:-2,-2,-2,2,2,2 --require 'top.flatness<=0.1,body.thickness>=2' --report regions.json"},
       {"A face from a mesh of its own, with a closer tolerance than the rest:",
        "vam-slice --shape box:x=6,y=6,z=2 --voxel 0.2 --stretch-z 1 -o design.vdb\n"
        "vam-slice --shape box:x=6.2,y=6.2,z=2.2 --voxel 0.2 --stretch-z 1 -o print.vdb\n"
        "printf 'OFF\\n4 2 0\\n-3 -3 1\\n3 -3 1\\n3 3 1\\n-3 3 1\\n3 0 1 2\\n3 0 2 3\\n' >seat.off\n"
        "vam-sdf print.vdb design.vdb --isovalue 0.5 --region seat=plane:seat.off --tolerance 0.2 --tolerance "
        "seat=0.15 "
        "--require 'within>=95,seat.within>=95'"},
       {"Compare repeated prints:",
        "vam-slice --shape box:x=6,y=6,z=6 --voxel 0.2 --stretch-z 1 -o design.vdb\n"
        "for n in 1 2 3 4; do vam-slice --shape box:x=6.$n,y=6.2,z=6.2 --voxel 0.2 --stretch-z 1 -o print.vdb; vam-sdf "
        "print.vdb "
        "design.vdb --isovalue 0.5 --samples 20000 --report run$n.json; done\nvam-sdf trend run1.json run2.json "
        "run3.json run4.json "
        "--plot trend.png"},
       {"Compare an embossed badge that is 1 % too small with its design:",
        "vam-slice --shape resolution:height=1 --voxel 0.1 --stretch-z 1 -o badge.vdb\nvam-slice --shape "
        "resolution:height=1 --voxel 0.1 --scale 0.99 --stretch-z 1 -o seen.vdb\nvam-sdf height seen.vdb badge.vdb "
        "--pixel 0.1 -o outline.png --plot section.png"}},
      {"Signs are determined by the generalised winding number, so that a design with holes is valid. Distances to "
       "the triangles are exact; extreme percentiles depend on --samples.",
       "Sources: Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, section 3 and "
       "table S1; Chen & Medioni, point-to-plane registration, 1992; Barill et al., Fast winding numbers, 2018."},
      {"vam-ost", "vam-dose", "vam-score", "vam-slice"}};
}

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
      .reads();
  app.option("--isovalue-uncertainty", "VALUE", options.isovalue_uncertainty, cli::non_negative,
             "Standard uncertainty of the isovalue, in its units.");
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
      .writes({".vdb"});
  app.option("--volume-voxel", "MM", options.volume_voxel_mm, cli::positive, "Voxel of --volume.")
      .default_is("1/100 of the design's largest dimension")
      .needs({"--volume"});
  app.option("--isovalue", "VALUE", options.isovalue, cli::any, "Isovalue of a print volume's surface, in its units.");
  app.option("--resin", "FILE", options.resin_record,
             "Record of vam-calibrate resin with the gelation threshold I_p, used as isovalue.")
      .reads();
  app.option("--design-isovalue", "VALUE", options.design_isovalue, cli::any, "Isovalue of a design volume's surface.");
  app.option("--min-body", "MM3", options.pieces_mm3, cli::non_negative,
             "Minimum volume of a body that belongs to the print; smaller bodies of a print volume are dropped.")
      .default_is("1 % of the largest body's volume");
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
           "Conditions of --require must hold for all values within the expanded uncertainty (ISO 14253-1).");
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
  app.option("--figure", "NAME", options.figure, "Figure of --plot.");
  app.option("--plot", "FILE", options.plot,
             "Plot the figure and its uncertainties over the prints (.png, .pdf or .svg).")
      .writes(plot::figure_endings());
  cli::add_report(app, options.report);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  HeightOptions height;
  declare(app, options);
  declare_height(app.subcommand("height", "compare a profilometer's height image of an embossed print with its design",
                                options.command),
                 height);
  TrendOptions trend;
  declare_trend(
      app.subcommand("trend", "compare repeated prints: mean, spread and drift of every figure", options.command),
      trend);
  return app.run(argc, argv, [&] {
    if (options.command == "height") return sdf_tool::height(height);
    if (options.command == "trend") return sdf_tool::trend(trend);
    sdf_tool::deviation(app, options);
  });
}
