// SPDX-License-Identifier: GPL-3.0-or-later
// vam-ost: optical scattering tomography, from camera views to the scattering volume of the print.
#include <malloc.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/mesh/file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "plot/save.hpp"
#include "session/printer.hpp"
#include "vam-ost/print.hpp"
#include "vam-ost/session.hpp"

namespace {

using namespace vam;
using ost_tool::Options;

void declare_camera(cli::App& app, Options& o) {
  app.group("Camera");
  app.option("--view-step", "DEG", o.step_deg, cli::not_zero,
             "Angle between views without recorded angles. Negative: opposite direction of rotation.");
  app.option("--dark", "FILE", o.dark,
             "Image or stack without a print (dark, or of the vial before printing); its mean is subtracted.")
      .reads();
  app.option("--flat", "FILE", o.flat,
             "Image or stack of a uniform scene; views are divided by it after dark subtraction.")
      .reads()
      .default_is("camera.flat");
  app.option("--binning", "N", o.binning, {1, 16},
             "Binning of the recorded views: the mean of N x N pixels, in addition to the camera's binning.");
  app.option("--pixel", "MM", o.pixel_mm, cli::positive, "Pixel pitch of the frames at the axis, before --binning.")
      .default_is("as stated in the stack, else camera.pixel_mm");
  app.option("--axis-column", "PX", o.axis_column, cli::any, "Column of the rotation axis, before --binning.")
      .default_is("camera.axis_column, else found in the views");
  app.option("--tilt", "DEG", o.tilt_deg, {-30, 30}, "Tilt of the axis, positive with its lower end to the right.")
      .default_is("camera.tilt_deg, else found in the views");
}

void declare_reconstruction(cli::App& app, Options& o) {
  app.group("Reconstruction");
  app.option("--voxel", "MM", o.how.voxel_mm, cli::non_negative, "Edge of a voxel; 0: the pixel pitch after binning.");
  app.option("--radius", "MM", o.how.radius_mm, cli::non_negative, "Radius of the volume; 0: the whole field of view.");
  app.choice("--filter", o.how.window,
             {"ram-lak", "shepp-logan", "cosine", "hamming", "hann", "gaussian", "exponential"},
             "Window of the ramp filter.");
  app.option("--mlem-iterations", "N", o.how.mlem_iterations, {0, 1000},
             "Number of MLEM iterations after the back-projection, for noisy views.");
  app.option("--uncertainty", "FILE.vdb", o.uncertainty,
             "Write the standard deviations of the volume's values due to the noise of the views, as a volume "
             "'uncertainty' for vam-sdf; a mesh (.ply) has those of its vertices in mm (scalar_uncertainty).")
      .writes({".vdb"})
      .excludes({"--mlem-iterations"});
  app.choice("--negative", o.negative, {"clip", "keep"}, "Negative densities: clip them to 0, or keep them.")
      .excludes({"--mlem-iterations"});
  app.flag("--no-refraction", o.no_refraction,
           "Neglect refraction and perspective: image columns are parallel rays (for comparison).");
  app.flag("--keep-run-out", o.keep_run_out, "Take the vial's axis for that of the stage: run-out is not fitted.")
      .excludes({"--no-refraction"});
}

void declare_print(cli::App& app, Options& o) {
  app.group("Print");
  const std::vector<std::string> shown_by{"--mesh", "--projections", "--report", "--log", "--page", "--until"};
  app.option("--isovalue", "VALUE", o.isovalue, cli::positive, "Gelation threshold I_p.")
      .excludes({"--resin"})
      .only_with(shown_by);
  app.option("--resin", "FILE", o.resin_record, "Record of vam-calibrate resin with the gelation threshold I_p.")
      .reads()
      .only_with(shown_by);
  app.option("--min-body", "MM3", o.pieces_mm3, cli::non_negative,
             "Minimum volume of a body that belongs to the print.")
      .default_is("1 % of the largest body's volume")
      .only_with({"--isovalue", "--resin"});
  app.option("--mesh", "FILE", o.mesh, "Write the surface at I_p (" + join(io::written_mesh_endings(), " or ") + ").")
      .writes(io::written_mesh_endings())
      .only_with({"--isovalue", "--resin"});
  app.option("--projections", "FILE", o.projections,
             "Write sum projections of volume, print and target (.png, .pdf or .svg).")
      .writes(plot::figure_endings());
  app.option("--target", "FILE.vdb", o.target,
             "Volume of the part to compare the print with, in the same coordinate system.")
      .reads()
      .only_with({"--isovalue", "--resin", "--projections"});
}

void declare_live(cli::App& app, Options& o) {
  app.group("Live", {"--live"});
  app.flag("--live", o.live, "Reconstruct while views arrive; -o is a folder.")
      .form()
      .only_with({"--output", "--log", "--page", "--until"})
      .excludes({"--report", "--uncertainty"});
  app.flag("--uncertainties", o.uncertainties,
           "Write the standard deviations of each volume's values into the folder, too, before the volume.")
      .only_with({"--output"})
      .excludes({"--mlem-iterations"});
  app.option("--volume-step", "DEG", o.every_deg, cli::positive, "Angle between reconstructed volumes.");
  app.option("--until", "CONDITIONS", o.until,
             "Print a stop event and exit when all conditions hold, on missing and overcure (%), iou and cured (mm3).")
      .only_with({"--isovalue", "--resin"})
      .only_with({"--target"});
  app.option("--log", "FILE", o.log, "Append one JSON line per volume; - is standard error.");
  app.option("--page", "FILE.html", o.page,
             "Write a page that refreshes itself (HTML), with the image of --projections.")
      .writes({".html"})
      .only_with({"--projections"});
}

void declare(cli::App& app, Options& o) {
  app.positional("VIEWS", o.views, "EXR frame stack, folder of images or video; - is standard input.").reads();
  cli::add_output(app, o.output).writes_as({".vdb", ".toml"});
  declare_camera(app, o);
  declare_reconstruction(app, o);
  declare_print(app, o);
  declare_live(app, o);
  cli::add_printer(app, o.printer);
  app.group("Output and performance");
  cli::add_report(app, o.report);
  cli::add_threads(app);
  app.usual({"--output", "--view-step", "--dark", "--flat", "--pixel", "--axis-column", "--voxel", "--isovalue",
             "--mesh", "--target", "--live", "--uncertainties", "--printer", "--set", "--report"});
}

void once(const cli::App& app, const Options& options) {
  ost_tool::Session session(app, options);
  ost_tool::Print print(app, options, session.printer().camera);
  io::ViewSource source(options.views, options.step_deg.value_or(0));
  const std::vector<metrology::CameraView> views = session.usable_views(source, io::input_name(options.views));
  auto [made, problem] = session.attempt(views, source.pixel_mm());
  if (!made) throw Error{Fault::data, io::input_name(options.views) + ": " + problem};
  model::Volume& volume = *made;
  print.require_in(volume);
  session.write(volume, options.output, {source.history()});
  print.keep(volume);
  print.require_kept();
  std::optional<metrology::VoxelUncertainty> sigma;
  if (!options.uncertainty.empty()) {
    sigma = session.uncertainty(views);
    session.write(*sigma, options.uncertainty, {source.history()});
  }
  print.write(volume, sigma ? &*sigma : nullptr);
  Json report = session.figures(volume);
  report.update(print.figures(volume));
  io::write_report(options.report, "vam-ost", report);
}

void run(const cli::App& app, const Options& options) {
  if (session::print_printer(options.printer)) return;
  if (!options.projections.empty()) plot::require_figures();
  options.live ? ost_tool::live(app, options) : once(app, options);
}

}  // namespace

int main(int argc, char** argv) {
  // Images of views and heights come and go by the thousand: memory that was freed is kept, as pages that are new are
  // cleared (149 000 page faults become 104 000), and for all threads together, as each would keep its own.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_ARENA_MAX, 1);
  cli::App app(
      {"vam-ost", "reconstruct the scattering volume of a print from camera views of the rotating vial", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
