// vam-resample: sinograms between the ideal parallel beam and a real projector or camera.
#include <sstream>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr_stack.hpp"
#include "io/stack_batches.hpp"
#include "io/stream.hpp"
#include "optics/resample_stack.hpp"
#include "printer.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string to = "projector";
  std::string interpolation = "cubic";
  bool no_fresnel = false;
  bool no_jacobian = false;
  bool fresnel = false;
  bool jacobian = false;
  bool keep_negative = false;
  double angle_offset_deg = 0;
  optics::Alignment alignment;
  std::optional<double> voxel_mm;
  std::optional<int> columns;
  bool explain = false;
  cli::PrinterOptions printer;
  io::StackOptions stack;
};

cli::Manual manual() {
  return {
      "vam-resample",
      "map sinograms between the parallel beam and a real projector or camera",
      {"Projections are computed for parallel light. A real projector's rays diverge, and the vial refracts them like "
       "a strong lens: the light of column x_p runs through the resin along another line, at offset x_v and turned by "
       "delta. vam-resample turns a virtual (parallel-beam) sinogram S_v into the one to project, S_p(x_p, theta) = "
       "S_v(x_v, theta + delta) J/T, where J = dx_v/dx_p keeps the light per width and T is the Fresnel transmittance. "
       "The map is exact for any number of concentric shells (vial.wall_mm), a telecentric or diverging lens, and a "
       "bath behind a flat window.",
       "With --to virtual it does the reverse for a camera that looks at the vial: camera sinograms become "
       "parallel-beam ones, ready for filtered back-projection. The camera's azimuth counts counter-clockwise from the "
       "projector, seen from above.",
       "Columns whose ray misses the resin, or falls outside the input, are 0. The sinogram must cover one full turn. "
       "The output of --to projector has the projector's columns, with the axis at projector.axis_column."},
      {{"Correct the projections of a part for the default printer:",
        "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip | vam-resample -o "
        "frames.exr"},
       {"Show the map of a telecentric projector as CSV:",
        "vam-resample --explain --set projector.telecentric=true -o map.csv"},
       {"The same part for a vial with a glass wall:",
        "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip | vam-resample --set "
        "vial.wall_mm=1 --set vial.index_glass=1.52 -o wall.exr"}},
      {"Memory: five batches of 16 slices, whatever the length of the stack. Time: below 1 ms a slice of 1024 x 360 "
       "and core.",
       "Accuracy: the ray map agrees with a vector ray tracer to 1e-9. Cubic (Catmull-Rom) interpolation is of third "
       "order and the default because it measures better than linear, which the paper uses. Its overshoot below 0, and "
       "whatever else is negative, is set to 0 on the way to a projector, which cannot show it; --keep-negative leaves "
       "it. An output with coarser columns than its input is averaged over the width of its columns.",
       "Weights: to the projector J/T by default. From the camera none by default; --fresnel divides by T, the light "
       "that was lost on its way out, and --jacobian divides by J.",
       "Sources: Orth et al., Correcting ray distortion in tomographic additive manufacturing, Opt. Express 2021, eq "
       "3-7 and fig 4; Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, eq 5-9, with "
       "the exact angles."},
      {"vam-dose", "vam-optimize", "vam-ost", "vam-project", "vam-sinogram"}};
}

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

void run(const cli::App& app, Options& options) {
  check(options);
  const bool projector = options.to == "projector";
  const model::Printer printer = tool::load_printer(options.printer);
  if (tool::print_printer(options.printer, printer, options.output)) return;

  optics::ResampleOptions how;
  how.interpolation = options.interpolation == "linear" ? optics::Interpolation::linear : optics::Interpolation::cubic;
  how.fresnel = projector ? !options.no_fresnel : options.fresnel;
  how.jacobian = projector ? !options.no_jacobian : options.jacobian;
  how.keep_negative = !projector || options.keep_negative;
  options.alignment.angle_offset_rad = options.angle_offset_deg * rad_per_deg;
  if (options.explain) {
    std::ostringstream map;
    optics::write_map(map, projector ? optics::projector_view(printer) : optics::camera_view(printer),
                      projector ? optics::projector_detector(printer, options.alignment)
                                : optics::camera_detector(printer, options.alignment),
                      how);
    return io::write_text(options.output, map.str());
  }

  io::refuse_same_file(options.input, options.output);
  io::StackReader in(options.input);
  if (projector && in.info().kind == model::Kind::sinogram && in.info().space == model::Space::projector) {
    throw Error{Fault::data, (options.input == "-" ? "stdin" : options.input) +
                                 ": holds the projector's columns already (vam-optimize --geometry vial, or resampled "
                                 "before); leave vam-resample out"};
  }
  io::require(options.input, in.info(), model::Kind::sinogram,
              projector ? model::Space::virtual_ : model::Space::camera);
  optics::StackResampling job = projector ? optics::stack_to_projector(printer, options.alignment, in.info(), how)
                                          : optics::stack_to_virtual(printer, options.alignment, in.info(), how,
                                                                     options.voxel_mm, options.columns);
  job.info.history.push_back(app.history());
  io::StackWriter out(options.output, job.info, options.stack);
  io::transform(in, out, 16, [&](const std::vector<Image>& slices) {
    std::vector<Image> resampled(slices.size());
    optics::resample(job.plan, slices, resampled);
    return resampled;
  });
  out.commit();
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
