// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-resample/options.hpp"

#include "base/error.hpp"

namespace vam::resample_tool {

namespace {

const std::vector<std::string> to_projector{"--geometry vial"};
const std::vector<std::string> to_bins{"--geometry parallel"};

}  // namespace

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
      .form()
      .excludes({"--interpolation", "--negative", "--angle-offset", "--reverse", "--bin-width", "--detector-bins",
                 "--half", "--compression"});
  app.option("--row", "N", options.row, {0, 65535},
             "Write the exact rays of this projector row (0 is the top) instead of horizontal rays: "
             "column,row,x_p_mm,z_p_mm,x_v_mm,z_mm,climb,delta_deg,T.")
      .only_with({"--explain"})
      .only_with(to_projector);
  app.group("Weights");
  app.flag("--no-fresnel", options.no_fresnel, "Do not divide by the transmittance T.").only_with(to_projector);
  app.flag("--no-jacobian", options.no_jacobian, "Do not multiply by J.").only_with(to_projector);
  app.flag("--fresnel", options.fresnel, "Divide by T.").only_with(to_bins);
  app.flag("--jacobian", options.jacobian, "Divide by J.").only_with(to_bins);
  app.choice("--negative", options.negative, {"clip", "keep"}, "Clip negative values to 0, or keep them.")
      .only_with(to_projector);
  app.group("Alignment");
  app.option("--column-offset", "PX", options.alignment.column_offset, cli::any,
             "Distance in columns from projector.axis_column (or the middle of the camera image) to the image of the "
             "axis, positive to the right.");
  app.option("--angle-offset", "DEG", options.angle_offset_deg, cli::any, "Angle of the part at stage angle 0.");
  app.flag("--reverse", options.alignment.reverse, "Direction of rotation opposite to stage.direction.");
  app.group("Detector bins");
  app.option("--bin-width", "MM", options.bin_width_mm, cli::positive, "Width of a detector bin.").only_with(to_bins);
  app.default_is("the slice height, so that voxels are cubes");
  app.option("--detector-bins", "N", options.bins, {1, 65536}, "Number of detector bins.").only_with(to_bins);
  app.default_is("all that the camera sees");
  cli::add_printer(app, options.printer);
  app.group("Output and performance");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
  app.usual({"--output", "--geometry", "--interpolation", "--explain", "--reverse", "--bin-width", "--printer", "--set",
             "--report"});
}

void check(const Options& options, const model::Printer& printer) {
  if (options.row && *options.row >= printer.projector.rows) {
    throw Error{Fault::usage, "--row " + std::to_string(*options.row) + ": the projector's rows are 0 ... " +
                                  std::to_string(printer.projector.rows - 1)};
  }
}

}  // namespace vam::resample_tool
