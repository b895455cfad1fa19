// SPDX-License-Identifier: GPL-3.0-or-later
// vam-resample: sinograms between the ideal parallel beam and a real projector or camera.
#include <sstream>
#include <vector>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/exr/stack_batches.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "optics/ray_list.hpp"
#include "optics/resample_stack.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"
#include "vam-resample/options.hpp"

namespace {

using namespace vam;
using resample_tool::Options;

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
