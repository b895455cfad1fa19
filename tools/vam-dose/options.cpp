// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/options.hpp"

namespace vam::dose_tool {

namespace {

void declare_volume(cli::App& app, Options& options) {
  app.group("Volume");
  app.option(
         "--like", "FILE", options.like,
         "Volume (VDB) that determines the voxels of the dose; its grid 'target' is the part to which the report "
         "refers (of a grey target, a dose, only the voxels count), its grid 'insert' an opaque object in the beam.")
      .reads();
  app.option("--size", "MM", options.size_mm, cli::positive,
             "Edge of the square volume around the axis; the voxel size is the slice height.")
      .excludes({"--like"});
  app.default_is("the region that is lit from all stage angles (projector), or the width of the sinogram (virtual)");
  app.option("--poses", "FILE", options.poses,
             "Pose of the vial or the part in every frame: a table (CSV) with the columns "
             "angle_deg,dx_mm,dy_mm,dz_mm,moves, one line per frame.")
      .reads()
      .not_for({"virtual sinograms"});
  app.default_is("the poses of the stack, or none");
}

void declare_beam(cli::App& app, Options& options) {
  app.group("Beam and resin");
  app.option("--full-scale", "VALUE", options.full_scale, cli::positive,
             "Sinogram value shown at full intensity; larger values are clipped, values below "
             "projector.min_intensity_mw_cm2 are raised to it.");
  app.default_is("the maximum of the stack, with zero intensity at grey 0");
  app.option("--bits", "N", options.bits, {1, 16},
             "Quantise intensities to the grey levels of this bit depth, through projector.response or else a linear "
             "response from projector.min_intensity_mw_cm2.")
      .only_with({"--full-scale"});
  app.option("--dither", "N", options.dither_turns, {1, 1000},
             "Round as vam-project --dither N does, and expose to the mean over the N turns.")
      .only_with({"--bits"});
  app.option("--diffusion-time", "S", options.diffusion_time_s, cli::non_negative,
             "Time in which the light arrives, and the dose diffuses.")
      .only_with({"resin.diffusion_mm2_s"})
      .excludes({"--no-blur"});
  app.default_is("the duration of the exposure");
  app.flag("--exposure-plan", options.exposure_plan,
           "Determine the number of whole turns and the fraction of full intensity that put the critical dose in the "
           "middle half of the process window, and write the dose of that exposure.")
      .only_with({"--like"})
      .only_with({"resin.critical_dose_mj_cm3"})
      .only_with({"resin.absorption_per_mm"})
      .not_for({"poses that do not return"});
  app.option("--shown", "RUN", options.shown,
             "Compute the dose that this print delivered: the run folder of vam-print, or the flip log of vam-project. "
             "Give it once for the print and once for each resumption. Logs that were cut or changed are refused "
             "(vam-formats(7), EVENT LOGS).")
      .excludes({"--exposure-plan"})
      .not_for({"virtual sinograms"});
  app.option("--before", "SECONDS", options.before_s, cli::any,
             "With --shown, count light before this time only, on the clock of the logs (t_monotonic_s). Where a print "
             "that goes on has not reached it, its light goes on as in its last frames.")
      .only_with({"--shown"});
  app.flag("--no-blur", options.no_blur, "Neglect point spread and diffusion.")
      .only_with({"resin.psf_mm", "resin.diffusion_mm2_s"});
  app.flag("--in-plane", options.in_plane,
           "For comparison: expose each slice with its own row of the projector only, as if rays did not climb.")
      .not_for({"virtual sinograms", "sinograms with poses"});
  app.choice("--negative", options.negative, {"clip", "keep"},
             "Negative intensities, which no projector can show: clip them to 0, or keep them. Those of a virtual "
             "sinogram are kept, with a warning where these tools did not write it.")
      .not_for({"virtual sinograms"});
}

void declare_alignment(cli::App& app, Options& options) {
  app.group("Alignment", {}, {"virtual sinograms"});
  app.option("--column-offset", "PX", options.alignment.column_offset, cli::any,
             "Distance in columns from projector.axis_column to the image of the axis, positive to the right.");
  app.option("--angle-offset", "DEG", options.angle_offset_deg, cli::any, "Angle of the part at stage angle 0.");
  app.flag("--reverse", options.alignment.reverse, "Direction of rotation opposite to stage.direction.");
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional(
         "SINOGRAM ...", options.inputs,
         "Sinogram stack (EXR) of a projector, or a virtual one; with --shown, all that the print showed, by default "
         "the sinogram.exr of its run folder if nothing comes through a pipe.")
      .reads();
  cli::add_output(app, options.output).writes_as({".vdb", ".toml"});
  cli::add_report(app, options.report);
  declare_volume(app, options);
  declare_beam(app, options);
  declare_alignment(app, options);
  cli::add_printer(app, options.printer);
  app.group("Performance");
  cli::add_threads(app);
  app.usual({"--output", "--report", "--like", "--poses", "--bits", "--exposure-plan", "--shown", "--reverse",
             "--printer", "--set"});
}

}  // namespace vam::dose_tool
