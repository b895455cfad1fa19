// vam-ost: optical scattering tomography, from camera views to the scattering volume of the print.
#include <cstdio>

#include "base/error.hpp"
#include "base/json.hpp"
#include "io/settings/report.hpp"
#include "moved.hpp"
#include "printer.hpp"
#include "vam-ost/print.hpp"
#include "vam-ost/session.hpp"

namespace {

using namespace vam;
using ost_tool::Options;

cli::Manual manual() {
  return {
      "vam-ost",
      "reconstruct the scattering volume of a print from camera views of the rotating vial",
      {"Liquid resin is clear; the solidifying part scatters light. A camera beside the vial records the scattered "
       "light; the views of a full turn determine the whole volume. vam-ost corrects the views (dark, flat field, "
       "binning), finds the rotation axis in them, compensates refraction and perspective by exact rays in three "
       "dimensions, and "
       "reconstructs the scattering density by filtered back-projection into a volume 'scatter', in view units per "
       "mm.",
       "VIEWS is an EXR frame stack of a camera, a folder of numbered images, or a video; frames "
       "without recorded angles need --angle-step. Each frame is placed by its own angle: missing, repeated and "
       "unevenly spaced frames are "
       "weighted, and "
       "a gap of more than 15 degrees is an error. An even background is fitted and "
       "subtracted; specks on window or lens, which stay where they are, and bubbles, which pass, are "
       "distinguished from the print because a ray and its reverse, half a turn later, disagree, and are replaced by "
       "the other one; --report states their fractions. Image rows run downwards along the axis; the row level with "
       "the "
       "lens, "
       "camera.axis_row or the middle one, is z = 0.",
       "With a gelation threshold I_p (--isovalue, or --resin with a record of vam-calibrate resin) the print is { "
       "scatter >= I_p }: --mesh writes its surface, --projections an image for the operator. Bodies of less than "
       "1 % of the largest body's volume (--pieces) and, with --target, bodies farther than 1 mm from the target are "
       "not part of the print; they stay in the volume, and --report counts them.",
       "--live reads frames as they arrive, keeps the last full turn, and for every turn (or every --every degrees) "
       "writes a volume into the folder -o, a line of JSON to --log, and updates --projections and --page. With "
       "--target it reports how much of the target is cured, missing and overcured; with --until it prints one line "
       "of JSON on standard output when the conditions hold, and exits: the signal to darken the projector. Frames are "
       "read while a volume is computed; dark and saturated frames are skipped and counted. A turn that makes no "
       "volume, because nothing has gelled yet or views are missing, is reported with the reason in the log, and the "
       "next one is reconstructed."},
      {{"Views of a synthetic cylinder as a camera records them:",
        "vam-slice --shape cylinder:diameter=6,height=3 --voxel 0.2 --stretch-z 1 -o design.vdb\nvam-sinogram "
        "design.vdb --angles 90 | vam-resample -o seen.exr\nvam-project seen.exr -o views --set projector.fps=2.5"},
       {"Reconstruct from a folder of images taken every 4 degrees:",
        "vam-ost views --angle-step 4 --pixel 0.065 --set camera.distance_mm=119.808 --set camera.azimuth_deg=0 -o "
        "scatter.vdb --projections seen.png"},
       {"Calibrate the gelation threshold with it, and use it:",
        "vam-calibrate resin scatter.vdb --diameter 6 -o resin.json\nvam-ost views --angle-step 4 --pixel 0.065 --set "
        "camera.distance_mm=119.808 --resin resin.json --mesh print.ply -o again.vdb"}},
      {"Memory: about four times the views of one turn and the volume. Time: about a second for 180 views of 480 x 300 "
       "pixels on two cores.",
       "Struts three voxels apart keep a contrast of 29 % with the default filter, 14 % with hann, which smooths noise "
       "more. The axis is the centre of symmetry of the mean view, row by row, by least squares; column, tilt and "
       "their standard deviations are reported.",
       "Sources: Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022; Shepp & Vardi, "
       "maximum likelihood reconstruction, 1982 (--statistical)."},
      {"vam-calibrate", "vam-capture", "vam-sdf", "vam-view", "vam-resample"},
      {"In captured stacks the attributes vam:angle_deg and vam:time_s give a view's angle and time; a view marked "
       "vam:incomplete is skipped with a warning that names its vam:number."}};
}

void declare(cli::App& app, Options& o) {
  app.positional("VIEWS", o.views, "EXR frame stack, folder of images or video; - is standard input.").reads();
  cli::add_output(app, o.output);
  app.group("Camera");
  app.option("--angle-step", "DEG", o.step_deg, cli::any,
             "Angular step of frames without recorded angles, not 0. Negative: opposite direction.")
      .was("--step");
  app.option("--dark", "FILE", o.dark,
             "Image or stack without a print (in the dark, or of the vial before printing); its mean is subtracted.")
      .reads();
  app.option("--flat", "FILE", o.flat,
             "Image or stack of a uniform scene; views are divided by it after dark subtraction. Default: camera.flat.")
      .reads();
  app.option("--binning", "N", o.binning, {1, 16}, "Average N x N pixels of the views, in addition to camera.binning.");
  app.option("--pixel", "MM", o.pixel_mm, cli::positive,
             "Pixel pitch of the views at the axis, before --binning. Default: the stack's, else camera.pixel_mm.");
  app.option("--axis", "PX", o.axis_column, cli::any,
             "Column of the axis before binning. Default: camera.axis_column, else found in the views.");
  app.option(
      "--tilt", "DEG", o.tilt_deg, {-30, 30},
      "Tilt of the axis, positive with its lower end to the right. Default: camera.tilt_deg, else found in the views.");
  app.group("Reconstruction");
  app.option("--voxel", "MM", o.how.voxel_mm, cli::non_negative, "Voxel edge length; 0: the binned pixel.");
  app.option("--radius", "MM", o.how.radius_mm, cli::non_negative,
             "Radius of the volume; 0: all that the camera sees.");
  app.choice("--filter", o.how.window,
             {"ram-lak", "shepp-logan", "cosine", "hamming", "hann", "gaussian", "exponential"},
             "Window of the ramp filter.");
  app.was("--window");
  app.option("--statistical", "N", o.how.statistical, {0, 1000},
             "Number of MLEM iterations after the back-projection, for noisy views.");
  app.choice("--negative", o.negative, {"clip", "keep"}, "Negative densities: clip them to 0, or keep them.");
  app.was("--keep-negative", "keep");
  app.flag("--no-refraction", o.no_refraction, "Treat image columns as parallel rays (for comparison).");
  app.group("Print");
  app.option("--isovalue", "VALUE", o.isovalue, cli::positive, "Gelation threshold I_p.").was("--level");
  app.option("--resin", "FILE", o.resin_record, "Record of vam-calibrate resin that holds I_p.").reads();
  app.option("--pieces", "MM3", o.pieces_mm3, cli::non_negative,
             "Smallest body that belongs to the print. Default: 1 % of the largest body's volume.");
  app.option("--mesh", "FILE", o.mesh, "Surface at I_p: .ply or .stl.")
      .writes({".ply", ".stl"})
      .needs({"--isovalue", "--resin"});
  app.option("--projections", "FILE.png", o.projections, "Sum projections of volume, print and target.")
      .writes({".png"});
  app.option("--target", "FILE.vdb", o.target, "Volume with the part to compare with, in the same coordinate system.")
      .was("--reference")
      .reads();
  app.group("Live");
  app.flag("--live", o.live, "Reconstruct as frames arrive; -o is a folder.").form();
  app.option("--every", "DEG", o.every_deg, cli::positive, "Rotation between volumes.").needs({"--live"});
  app.option(
         "--until", "CONDITIONS", o.until,
         "Print a stop event and exit when all conditions hold: missing and overcure in per cent, iou, cured in mm3.")
      .needs({"--live"})
      .needs({"--isovalue", "--resin"})
      .needs({"--target"});
  app.option("--log", "FILE", o.log, "Append a line of JSON for every volume; - is standard error.").needs({"--live"});
  app.option("--page", "FILE.html", o.page, "Page that shows --projections and refreshes itself.")
      .writes({".html"})
      .needs({"--live"})
      .needs({"--projections"});
  cli::add_printer(app, o.printer);
  app.group("Output and machine");
  cli::add_report(app, o.report);
  cli::add_threads(app);
}

void once(const cli::App& app, const Options& options) {
  ost_tool::Session session(app, options);
  ost_tool::Print print(app, options, session.printer().camera);
  io::ViewSource source(options.views, options.step_deg);
  std::vector<metrology::CameraView> views;
  io::CameraFrame frame;
  while (source.next(frame)) {
    metrology::require_exposed(frame.image, frame.name);
    views.push_back(session.take(frame));
  }
  metrology::require_alike(views);
  model::Volume volume = session.reconstruct(views, source.pixel_mm());
  print.require_in(volume);
  session.write(volume, options.output, source.history());
  print.keep(volume);
  print.write(volume);
  Json report = session.figures(volume);
  report.update(print.figures(volume));
  io::write_report(options.report, "vam-ost/1", report);
}

void run(const cli::App& app, const Options& options) {
  if (tool::print_printer(options.printer)) return;
  if (app.given("--angle-step") && options.step_deg == 0) {
    throw Error{Fault::usage, "--angle-step: is 0; give the angle from view to view"};
  }
  if (options.live && app.given("--report")) {
    throw Error{Fault::usage, "--report: is of one volume; with --live the figures of each go to --log"};
  }
  options.live ? ost_tool::live(app, options) : once(app, options);
}

}  // namespace

int main(int argc, char** argv) {
  const int moved = tool::follow_moved(argc, argv, {"threshold"}, "vam-calibrate resin");
  if (moved >= 0) return moved;
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
