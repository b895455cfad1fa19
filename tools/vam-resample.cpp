// SPDX-License-Identifier: GPL-3.0-or-later
// vam-resample: sinograms between the ideal parallel beam and a real projector or camera.
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "io/exr/stack_batches.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "optics/ray_list.hpp"
#include "optics/resample_stack.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"

namespace {

using namespace vam;
struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string geometry = "vial";
  std::string interpolation = "cubic";
  bool no_fresnel = false;
  bool no_jacobian = false;
  bool fresnel = false;
  bool jacobian = false;
  std::string negative = "clip";
  double angle_offset_deg = 0;
  optics::AxisAlignment alignment;
  std::optional<double> bin_width_mm;
  std::optional<int> bins;
  bool explain = false;
  std::optional<int> row;  // of the projector, whose rays to explain
  cli::PrinterOptions printer;
  io::StackOptions stack;
  /// Whether the columns are those of the projector, whose rays the vial refracts.
  [[nodiscard]] bool in_vial() const { return geometry == "vial"; }
};

const std::vector<std::string> to_projector{"--geometry vial"};
const std::vector<std::string> to_bins{"--geometry parallel"};

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

void explain(const Options& options, const model::Printer& printer, const optics::ResampleOptions& how) {
  const bool projector = options.in_vial();
  const optics::Detector detector = projector ? optics::projector_detector(printer, options.alignment)
                                              : optics::camera_detector(printer, options.alignment);
  std::ostringstream map;
  if (options.row) {
    optics::write_rays(map, printer, detector, *options.row);
  } else {
    optics::write_map(map, projector ? optics::projector_view(printer) : optics::camera_view(printer), detector, how);
  }
  io::write_text(options.output, map.str());
}

/// Half a slice: up to there light stays in its own.
void warn_of_climb(const Options& options, const model::Printer& printer, const model::StackInfo& info) {
  constexpr double noticed = 0.5;
  const double crossed = optics::crossed_slices(printer, info);
  if (crossed < noticed) return;
  warn(io::input_name(options.input) + ": the projector's rays climb, by up to " + format_number(crossed, 3) +
       " voxels out of their slice; resampling treats them as horizontal, vam-optimize --geometry vial does not");
}

void run(const cli::App& app, Options& options) {
  const bool projector = options.in_vial();
  const model::Printer printer = session::load_printer(options.printer);
  check(options, printer);
  if (session::print_printer(options.printer, printer, options.output)) return;

  optics::ResampleOptions how;
  how.interpolation = options.interpolation == "linear" ? optics::Interpolation::linear : optics::Interpolation::cubic;
  how.fresnel = projector ? !options.no_fresnel : options.fresnel;
  how.jacobian = projector ? !options.no_jacobian : options.jacobian;
  how.keep_negative = !projector || options.negative == "keep";
  options.alignment.angle_offset_rad = options.angle_offset_deg * rad_per_deg;
  if (options.explain) return explain(options, printer, how);

  io::StackReader in(options.input);
  if (projector && in.info().kind == model::Kind::sinogram && in.info().space == model::Space::projector) {
    throw Error{Fault::data, io::input_name(options.input) +
                                 ": already has projector columns (from vam-optimize --geometry vial, or already "
                                 "resampled); omit vam-resample"};
  }
  io::require(options.input, in.info(), model::Kind::sinogram,
              projector ? model::Space::virtual_ : model::Space::camera);
  optics::StackResampling job = projector ? optics::stack_to_projector(printer, options.alignment, in.info(), how)
                                          : optics::stack_to_virtual(printer, options.alignment, in.info(), how,
                                                                     options.bin_width_mm, options.bins);
  job.info.history.push_back(app.history());
  job.info.extra.erase("vam:judged_radius_mm");  // of parallel light
  if (projector) {
    session::forget_exposure(job.info.extra);  // which another printer, and brighter light, would not give
    job.info.extra["vam:printer"] = io::printer_settings(printer);
  }
  io::StackWriter out(options.output, job.info, options.stack);
  Progress progress("resampling", in.info().count);
  io::transform(in, out, 16, [&](const std::vector<Image>& slices) {
    std::vector<Image> resampled(slices.size());
    optics::resample(job.plan, slices, resampled);
    progress.tick(count_of(slices));
    return resampled;
  });
  out.commit();
  if (projector) warn_of_climb(options, printer, in.info());
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-resample", "map sinograms between the parallel beam and a real projector or camera", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
