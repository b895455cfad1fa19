#include "vam-resample/options.hpp"

#include "base/error.hpp"

namespace vam::resample_tool {

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.input, "Sinogram stack (EXR): virtual, or of a camera with --to virtual.");
  cli::add_output(app, options.output);
  app.choice("--to", options.to, {"projector", "virtual"}, "What the output's columns are.");
  app.choice("--interpolation", options.interpolation, {"linear", "cubic"}, "Across columns and in angle.");
  app.flag("--explain", options.explain,
           "Read no stack; write the map as CSV: x_p_mm,x_v_mm,delta_deg,T,J,weight, a line for each column.");
  app.group("Weights");
  app.flag("--no-fresnel", options.no_fresnel, "To the projector: do not divide by the transmittance T.");
  app.flag("--no-jacobian", options.no_jacobian, "To the projector: do not multiply by J.");
  app.flag("--fresnel", options.fresnel, "From the camera: divide by T.");
  app.flag("--jacobian", options.jacobian, "From the camera: divide by J.");
  app.flag("--keep-negative", options.keep_negative, "To the projector: leave values below 0 as they come.");
  app.group("Alignment");
  app.option("--column-offset", "PX", options.alignment.column_offset, cli::any,
             "The axis appears so many columns right of projector.axis_column (or of the camera's middle).");
  app.option("--angle-offset", "DEG", options.angle_offset_deg, cli::any, "The part stands at stage angle plus this.");
  app.flag("--reverse", options.alignment.reverse, "The stage turns against stage.direction.");
  app.group("Columns of --to virtual");
  app.option("--voxel", "MM", options.voxel_mm, cli::positive,
             "Column pitch; without it the pitch of the slices, as voxels are cubes.");
  app.option("--columns", "N", options.columns, {1, 65536}, "Columns; without it all that the camera can see.");
  cli::add_printer(app, options.printer);
  app.group("Output and machine");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
}

void check(const Options& options) {
  const bool projector = options.to == "projector";
  const auto refuse = [&](bool given, const char* flag) {
    if (given) throw Error{Fault::usage, std::string(flag) + ": has no meaning with --to " + options.to};
  };
  refuse(projector && options.fresnel, "--fresnel");
  refuse(projector && options.jacobian, "--jacobian");
  refuse(projector && options.voxel_mm, "--voxel");
  refuse(projector && options.columns, "--columns");
  refuse(!projector && options.no_fresnel, "--no-fresnel");
  refuse(!projector && options.no_jacobian, "--no-jacobian");
}

}  // namespace vam::resample_tool
