#include "vam-dose/options.hpp"

#include "base/constants.hpp"
#include "base/error.hpp"
#include "score/exposure.hpp"

namespace vam::dose_tool {

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.input, "Sinogram stack (EXR) of a projector, or a virtual one.").reads();
  cli::add_output(app, options.output);
  cli::add_report(app, options.report);
  app.group("Volume");
  app.option("--like", "FILE", options.like,
             "Volume (VDB) whose voxels the dose is computed on; a grid 'target' is the part of the report, a grid "
             "'insert' an opaque object in the beam.")
      .reads();
  app.option("--size", "MM", options.size_mm, cli::positive,
             "Edge of the square around the axis. Voxels are as high as slices.");
  app.default_is("all that is lit from every side (projector), or the width of the sinogram (virtual)");
  app.option("--poses", "FILE", options.poses,
             "Pose of the vial or the part in every frame: a table (CSV) with the columns "
             "angle_deg,dx_mm,dy_mm,dz_mm,moves, one line a frame.")
      .reads();
  app.default_is("the poses of the stack, or none");
  app.group("Beam and resin");
  app.option("--full-scale", "VALUE", options.full_scale, cli::positive,
             "Sinogram value shown at full intensity; larger values are clipped, values below "
             "projector.min_intensity_mw_cm2 are raised to it.");
  app.default_is("the maximum of the stack, zero intensity at grey 0");
  app.option("--diffusion-time", "S", options.diffusion_time_s, cli::non_negative,
             "Time during which the dose diffuses.");
  app.default_is("the duration of stage.turns turns").was("--seconds");
  app.flag("--exposure-plan", options.exposure_plan,
           "Determine whole turns and the fraction of full intensity that put the critical dose in the middle half of "
           "the "
           "process window, and write the dose of that exposure.")
      .needs({"--like"});
  app.option("--shown", "RUN", options.shown,
             "Compute the dose that this print actually delivered: the run folder of vam-print, or the flip log of "
             "vam-project; once for the print and once for each resumption.");
  app.flag("--no-blur", options.no_blur, "Neglect point spread and diffusion.");
  app.flag("--in-plane", options.in_plane,
           "For comparison: expose each slice with its own row of the projector only, as if rays did not climb.");
  app.was("--flat");
  app.choice("--negative", options.negative, {"clip", "keep"},
             "Negative intensities of a projector sinogram, which no projector can show: clip them to 0, or keep them. "
             "Those of a virtual sinogram are always kept.");
  app.was("--keep-negative", "keep");
  app.group("Alignment");
  app.option("--column-offset", "PX", options.alignment.column_offset, cli::any,
             "Columns between projector.axis_column and the image of the axis, positive to the right.");
  app.option("--angle-offset", "DEG", options.angle_offset_deg, cli::any, "Angle of the part at stage angle 0.");
  app.flag("--reverse", options.alignment.reverse, "The stage turns against stage.direction.");
  cli::add_printer(app, options.printer);
  app.group("Performance");
  cli::add_threads(app);
}

void settle(Options& options, const model::Printer& printer) {
  if (options.exposure_plan && !score::dose_per_radian_mj_cm3(printer)) {
    throw Error{Fault::usage,
                "--exposure-plan: requires resin.critical_dose_mj_cm3 and resin.absorption_per_mm; without them doses "
                "are relative"};
  }
  if (options.exposure_plan && !options.shown.empty()) {
    throw Error{Fault::usage, "--shown: the exposure is that of the print; omit --exposure-plan"};
  }
  if (!options.like.empty() && options.size_mm) {
    throw Error{Fault::usage, "--size: --like already determines the voxels"};
  }
  options.alignment.angle_offset_rad = options.angle_offset_deg * rad_per_deg;
}

}  // namespace vam::dose_tool
