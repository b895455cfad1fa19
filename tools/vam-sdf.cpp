// vam-sdf: how far a print is from its design.
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "vam-sdf/options.hpp"

namespace {

using namespace vam;
using sdf_tool::HeightOptions;
using sdf_tool::Options;

cli::Manual manual() {
  return {
      "vam-sdf",
      "measure the deviation of a print from its design",
      {"Reads the print (a mesh, or a volume whose surface is taken at --level) and the reference (a mesh, or a target "
       "volume), lays one onto the other, and measures signed distances: positive where the print stands outside the "
       "reference, as MeshLab, CloudCompare and Open3D have it. Statistics are of points spread evenly over the area, "
       "in both directions: from the print to the reference, and from the reference to the print, where alone missing "
       "pieces show.",
       "A volume is read in its own frame; the stretch in z that vam-slice applied is undone, so that a simulated dose "
       "can be held against the mesh it came from.",
       "--align full needs no start: centroids and principal axes give it, every symmetric variant is tried, and "
       "point-to-plane ICP ends it. --align icp trusts the pose of the files; --align none keeps it. With --scale the "
       "uniform scale is fitted too and reported as shrinkage.",
       "A table goes to standard error when that is a terminal, the figures as JSON to --report, the print with "
       "distances and blue-white-red colours to -o. With --require the exit status is 1 unless every condition holds.",
       "vam-sdf height compares a profilometer's picture of an embossed print with its design: the picture is levelled "
       "by the plane through its base, the design's outline at half height is laid onto the print's, with a scale that "
       "is reported as shrinkage, and outline, overlap and height are measured."},
      {{"Two boxes, one a little larger:",
        "vam-slice --shape box:x=6,y=6,z=6 --stretch-z 1 -o design.vdb\nvam-slice --shape box:x=6.2,y=6.2,z=6.2 "
        "--stretch-z 1 -o print.vdb\nvam-sdf print.vdb design.vdb --level 0.5 -o deviation.ply --report "
        "deviation.json"},
       {"A verdict for a script:", "vam-sdf print.vdb design.vdb --level 0.5 --require 'rms<=0.2' --histogram sdf.csv"},
       {"An embossed badge as a print would show it, 1 % too small, against its design:",
        "vam-slice --shape resolution:height=1 --voxel 0.1 --stretch-z 1 -o badge.vdb\nvam-slice --shape "
        "resolution:height=1 --voxel 0.1 --scale 0.99 --stretch-z 1 -o seen.vdb\nvam-sdf height seen.vdb badge.vdb "
        "--pixel 0.1 -o outline.png --plot section.png"}},
      {"Signs come from the generalised winding number, so that a reference with holes works. Distances are exact to "
       "the triangles; the fine percentiles depend on --samples.",
       "Sources: Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, section 3 and table "
       "S1; Chen & Medioni, point-to-plane registration, 1992; Barill et al., Fast winding numbers, 2018."},
      {"vam-ost", "vam-dose", "vam-score", "vam-slice"}};
}

void declare(cli::App& app, Options& options) {
  app.positional("PRINT", options.print, "Mesh (STL, OBJ, PLY, OFF, 3MF) or volume (.vdb).");
  app.positional("REFERENCE", options.reference, "Mesh or volume of the design.");
  app.option("-o,--output", "FILE.ply", options.output,
             "The aligned print with distances and colours at its vertices.");
  app.option("--level", "VALUE", options.level, cli::any, "Surface of a print volume: the threshold in its units.");
  app.option("--resin", "FILE", options.resin_record, "The same from a record of vam-ost threshold.");
  app.option("--reference-level", "VALUE", options.reference_level, cli::any, "Surface of a reference volume.");
  app.group("Alignment");
  app.choice("--align", options.align, {"none", "icp", "full"}, "How the print is laid onto the reference.");
  app.flag("--scale", options.scale, "Fit a uniform scale too.");
  app.group("Figures");
  app.option("--samples", "N", options.samples, {1000, 1e8}, "Points spread over each surface.");
  app.option("--histogram", "FILE", options.histogram,
             "Share of the area per distance: .png draws it, any other name is CSV.");
  app.option("--bins", "N", options.bins, {2, 10000}, "Bins of the histogram.");
  app.option("--limit", "MM", options.limit_mm, cli::positive,
             "End of the histogram and of the colours; the 99th percentile without it.");
  app.option("--require", "CONDITIONS", options.require,
             "Conditions on rms, mean, sigma, mad, max, hausdorff (mm) and rms_percent, e.g. 'rms<=0.2,hausdorff<1'.");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

void declare_height(cli::App& app, HeightOptions& options) {
  app.positional("PICTURE", options.picture,
                 "Profilometer's heights: PNG, TIFF or EXR; or a mesh or volume, seen from above.");
  app.positional("DESIGN", options.design, "Mesh or volume of the design, embossed side up.");
  app.option("--pixel", "MM", options.pixel_mm, cli::positive, "Pixel of the picture.");
  app.option("--full", "MM", options.full_mm, cli::positive,
             "Height of full scale of a PNG or TIFF; its level 0 is a lost reading. EXR values are multiplied by it.");
  app.option("--lowest", "MM", options.lowest_mm, cli::any, "Heights below it are not of the print (the stage).");
  app.option("--reference-level", "VALUE", options.reference_level, cli::any, "Surface of a design volume.");
  app.choice("--align", options.align, {"none", "icp", "full"},
             "How the design is laid onto the print: middle on middle, from there, or from any turn.");
  app.option("-o,--output", "FILE.png", options.output, "The levelled heights with the design's outline.");
  app.option("--line", "X0,Y0,X1,Y1", options.line, 4, "Ends of a section, in pixels from the top left.");
  app.option("--plot", "FILE.png", options.plot, "The heights along it; without --line down the middle.");
  app.option("--require", "CONDITIONS", options.require,
             "Conditions on rms and max (mm), iou, shrinkage (%), height (mm).");
  cli::add_report(app, options.report);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  HeightOptions height;
  declare(app, options);
  declare_height(app.subcommand("height", "compare a profilometer's picture of an embossed print with its design",
                                options.command),
                 height);
  return app.run(argc, argv,
                 [&] { options.command == "height" ? sdf_tool::height(height) : sdf_tool::deviation(app, options); });
}
