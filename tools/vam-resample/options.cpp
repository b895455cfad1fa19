// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-resample/options.hpp"

#include "base/error.hpp"

namespace vam::resample_tool {

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.input, "Sinogram stack (EXR): virtual, or of a camera with --geometry parallel.")
      .reads({"--explain"});
  cli::add_output(app, options.output).writes_as({".exr", ".csv", ".toml"});
  app.choice(
      "--geometry", options.geometry, {"vial", "parallel"},
      "Output: columns of the projector, whose rays the vial refracts, or detector bins of an ideal parallel beam.");
  app.choice("--interpolation", options.interpolation, {"linear", "cubic"}, "Interpolation across columns and angles.");
  app.flag(
         "--explain", options.explain,
         "Write the ray map as CSV instead: x_p_mm,x_v_mm,delta_deg,T,J,weight, one line per column. No input is read.")
      .form();
  app.option("--row", "N", options.row, {0, 65535},
             "Write the exact rays of this projector row (0 is the top) instead of horizontal rays: "
             "column,row,x_p_mm,z_p_mm,x_v_mm,z_mm,climb,delta_deg,T.")
      .needs({"--explain"});
  app.group("Weights");
  app.flag("--no-fresnel", options.no_fresnel, "--geometry vial: do not divide by the transmittance T.");
  app.flag("--no-jacobian", options.no_jacobian, "--geometry vial: do not multiply by J.");
  app.flag("--fresnel", options.fresnel, "--geometry parallel: divide by T.");
  app.flag("--jacobian", options.jacobian, "--geometry parallel: divide by J.");
  app.choice("--negative", options.negative, {"clip", "keep"},
             "--geometry vial: clip negative values to 0, or keep them.");
  app.group("Alignment");
  app.option("--column-offset", "PX", options.alignment.column_offset, cli::any,
             "Distance in columns from projector.axis_column (or the middle of the camera image) to the image of the "
             "axis, positive to the right.");
  app.option("--angle-offset", "DEG", options.angle_offset_deg, cli::any, "Angle of the part at stage angle 0.");
  app.flag("--reverse", options.alignment.reverse, "Direction of rotation opposite to stage.direction.");
  app.group("Detector bins of --geometry parallel");
  app.option("--bin-width", "MM", options.bin_width_mm, cli::positive, "Width of a detector bin.");
  app.default_is("the slice height, so that voxels are cubes");
  app.option("--detector-bins", "N", options.bins, {1, 65536}, "Number of detector bins.");
  app.default_is("all that the camera sees");
  cli::add_printer(app, options.printer);
  app.group("Output and performance");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
  app.usual({"--output", "--geometry", "--interpolation", "--explain", "--reverse", "--bin-width", "--printer", "--set",
             "--report"});
}

void check(const Options& options, const model::Printer& printer) {
  const bool projector = options.in_vial();
  const auto refuse = [&](bool given, const char* flag) {
    if (given) throw Error{Fault::usage, std::string(flag) + ": does not apply to --geometry " + options.geometry};
  };
  refuse(projector && options.fresnel, "--fresnel");
  refuse(projector && options.jacobian, "--jacobian");
  refuse(projector && options.bin_width_mm, "--bin-width");
  refuse(projector && options.bins, "--detector-bins");
  refuse(!projector && options.row, "--row");
  if (options.row && *options.row >= printer.projector.rows) {
    throw Error{Fault::usage, "--row " + std::to_string(*options.row) + ": the projector's rows are 0 ... " +
                                  std::to_string(printer.projector.rows - 1)};
  }
  refuse(!projector && options.no_fresnel, "--no-fresnel");
  refuse(!projector && options.no_jacobian, "--no-jacobian");
}

}  // namespace vam::resample_tool
