#include "vam-dose/options.hpp"

#include "base/constants.hpp"
#include "base/error.hpp"
#include "score/exposure.hpp"

namespace vam::dose_tool {

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.input, "Sinogram stack (EXR) of a projector, or a virtual one.");
  cli::add_output(app, options.output);
  cli::add_report(app, options.report);
  app.group("Volume");
  app.option("--like", "FILE", options.like,
             "Volume (VDB) whose voxels the dose takes; its grid 'target', if there, is the part of the report, its "
             "grid 'insert' an opaque object in the light.");
  app.option(
      "--size", "MM", options.size_mm, cli::positive,
      "Edge of the square around the axis. Without it all that is lit from every side (projector), or as wide as "
      "the sinogram (virtual). Voxels are as high as slices.");
  app.group("Light and resin");
  app.option("--full-scale", "VALUE", options.full_scale, cli::positive,
             "Sinogram value shown at full intensity; more is cut, less than projector.min_intensity_mw_cm2 raised. "
             "Without it the largest value of the stack, and no light at grey 0.");
  app.option("--seconds", "S", options.seconds, cli::non_negative,
             "Time for which dose diffuses. Without it the time of stage.turns turns.");
  app.flag("--exposure-plan", options.exposure_plan,
           "Choose whole turns and a fraction of full light that put the critical dose in the middle of the process "
           "window, and write the dose of that exposure. Needs --like with a target.");
  app.flag("--no-blur", options.no_blur, "Leave out point spread and diffusion.");
  app.flag("--keep-negative", options.keep_negative,
           "Take a projector's negative light as it is; no projector can show it. A virtual sinogram's always is.");
  app.group("Alignment");
  app.option("--column-offset", "PX", options.alignment.column_offset, cli::any,
             "The axis appears so many columns right of projector.axis_column.");
  app.option("--angle-offset", "DEG", options.angle_offset_deg, cli::any, "The part stands at stage angle plus this.");
  app.flag("--reverse", options.alignment.reverse, "The stage turns against stage.direction.");
  cli::add_printer(app, options.printer);
  app.group("Machine");
  cli::add_threads(app);
}

void settle(Options& options, const model::Printer& printer) {
  if (options.exposure_plan && options.like.empty()) {
    throw Error{Fault::usage, "--exposure-plan: needs to know the part; name its volume with --like"};
  }
  if (options.exposure_plan && !score::dose_per_radian_mj_cm3(printer)) {
    throw Error{Fault::usage,
                "--exposure-plan: needs resin.critical_dose_mj_cm3 and resin.absorption_per_mm, without which doses "
                "have no unit"};
  }
  if (!options.like.empty() && options.size_mm) {
    throw Error{Fault::usage, "--size: --like already says which voxels"};
  }
  options.alignment.angle_offset_rad = options.angle_offset_deg * rad_per_deg;
}

}  // namespace vam::dose_tool
