// vam-ost: optical scattering tomography, from camera views to the print as it stands.
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/event_log.hpp"
#include "io/image_figure.hpp"
#include "io/mesh_file.hpp"
#include "io/picture.hpp"
#include "io/printer_file.hpp"
#include "io/report.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "io/view_source.hpp"
#include "metrology/cured.hpp"
#include "metrology/ost.hpp"
#include "metrology/projection_sheet.hpp"
#include "metrology/sliding_turn.hpp"
#include "metrology/threshold.hpp"
#include "model/conditions.hpp"
#include "solid/isosurface.hpp"

namespace {

using namespace vam;

struct Options {
  std::string command;
  std::string views = "-";
  std::string output = "-";
  double step_deg = 0;
  std::string dark, flat;
  int binning = 1;
  std::optional<double> pixel_mm, axis_column, tilt_deg;
  metrology::OstOptions how;
  bool no_refraction = false;
  bool keep_negative = false;
  std::optional<double> level;
  std::string resin_record;
  std::string mesh, projections;
  bool live = false;
  double every_deg = 360;
  std::string reference, until, log, page;
  std::string report;
  cli::PrinterOptions printer;
  std::string scatter = "-";
  std::string record = "-";
  std::string profile;
  std::optional<double> diameter_mm;
  double profile_pixel_mm = 0.05;
};

cli::Manual manual() {
  return {
      "vam-ost",
      "see the print: scattering volume from camera views of the turning vial",
      {"Liquid resin is clear and the solidifying part scatters light. A camera beside the vial sees that light; over "
       "a "
       "full turn its views hold the whole volume. vam-ost corrects the views (dark, flat field, binning), finds the "
       "rotation axis in them, undoes refraction and perspective with the exact ray map, and reconstructs the "
       "scattering "
       "density by filtered back-projection into a volume 'scatter', in view units per mm.",
       "VIEWS is an EXR frame stack of a camera, a folder of numbered pictures, or a video; the latter two need "
       "--step. "
       "Each frame's own angle counts: frames that are missing, repeated or uneven are weighted, and a gap of more "
       "than "
       "15 degrees is refused. Image rows run downwards along the axis; the middle row is z = 0.",
       "With a level I_p (--level, or --resin with a record that vam-ost threshold wrote) the print is { scatter >= "
       "I_p "
       "}: --mesh writes its surface, --projections the operator's picture.",
       "--live reads frames as they come, keeps the last full turn, and for every turn (or every --every degrees) "
       "writes "
       "a volume into the folder -o, a line of JSON to --log, and renews --projections and --page. With --reference it "
       "reports how much of the design is cured, missing and overcured; with --until it prints one line of JSON on "
       "standard output when the condition holds, and ends: the signal to darken the projector.",
       "vam-ost threshold takes the scattering volume of a printed standard cylinder, of known diameter or measured on "
       "a "
       "profilometer's picture, and gives I_p with its spread."},
      {{"A synthetic cylinder, as a camera would see it, and back:",
        "vam-slice --shape cylinder:diameter=6,height=3 --voxel 0.2 --stretch-z 1 -o design.vdb\n"
        "vam-sinogram design.vdb --angles 90 | vam-resample -o seen.exr\n"
        "vam-project seen.exr -o views --set projector.fps=2.5"},
       {"Reconstruct from a folder of pictures taken every 4 degrees:",
        "vam-ost views --step 4 --pixel 0.065 --set camera.distance_mm=119.808 --set camera.azimuth_deg=0 "
        "-o scatter.vdb --projections seen.png"},
       {"Calibrate the threshold with it, and use it:",
        "vam-ost threshold scatter.vdb --diameter 6 -o resin.json\n"
        "vam-ost views --step 4 --pixel 0.065 --set camera.distance_mm=119.808 --resin resin.json "
        "--mesh print.ply -o again.vdb"}},
      {"Memory: the views of one turn and the volume, about four times both. Time: about a second for 180 views of 480 "
       "x "
       "300 pixels on two cores.",
       "The axis is the centre of symmetry of the mean view, row by row, by least squares; column, tilt and their "
       "standard "
       "deviations are reported.",
       "Sources: Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022; Shepp & Vardi, "
       "maximum "
       "likelihood reconstruction, 1982 (--statistical)."},
      {"vam-capture", "vam-sdf", "vam-view", "vam-resample"}};
}

void declare(cli::App& app, Options& o) {
  app.positional("VIEWS", o.views, "EXR frame stack, folder of pictures or video; - is standard input.");
  cli::add_output(app, o.output);
  app.group("Camera");
  app.option("--step", "DEG", o.step_deg, cli::any, "Angle between frames that carry none. Negative: the other way.");
  app.option("--dark", "FILE", o.dark, "Picture or stack taken in the dark, subtracted.");
  app.option("--flat", "FILE", o.flat, "Picture or stack of an even scene, divided out after the dark is subtracted.");
  app.option("--binning", "N", o.binning, {1, 16}, "Average N x N pixels.");
  app.option("--pixel", "MM", o.pixel_mm, cli::positive,
             "Pitch at the axis before binning; without it the stack's, else camera.pixel_mm.");
  app.option("--axis", "PX", o.axis_column, cli::any,
             "Column of the axis after binning; without it found in the views.");
  app.option("--tilt", "DEG", o.tilt_deg, {-30, 30},
             "Lean of the axis, its lower end to the right; without it found in the views.");
  app.group("Reconstruction");
  app.option("--voxel", "MM", o.how.voxel_mm, cli::non_negative, "Voxel edge; 0 is the binned pixel.");
  app.option("--radius", "MM", o.how.radius_mm, cli::non_negative, "Radius of the volume; 0 is all that is seen.");
  app.choice("--window", o.how.window,
             {"ram-lak", "shepp-logan", "cosine", "hamming", "hann", "gaussian", "exponential"},
             "Window of the ramp filter.");
  app.option("--statistical", "N", o.how.statistical, {0, 1000}, "Iterations of MLEM after it, for noisy views.");
  app.flag("--keep-negative", o.keep_negative, "Leave negative densities.");
  app.flag("--no-refraction", o.no_refraction, "Take columns as parallel rays (for comparison).");
  app.group("Print");
  app.option("--level", "VALUE", o.level, cli::positive, "Gelation threshold I_p.");
  app.option("--resin", "FILE", o.resin_record, "Record of vam-ost threshold that holds it.");
  app.option("--mesh", "FILE", o.mesh, "Surface at I_p, .ply or .stl.");
  app.option("--projections", "FILE.png", o.projections, "Sum projections of volume, print and reference.");
  app.option("--reference", "FILE.vdb", o.reference, "Design to compare with, in the same frame.");
  app.group("Live");
  app.flag("--live", o.live, "Reconstruct as frames come; -o is a folder.");
  app.option("--every", "DEG", o.every_deg, cli::positive, "Turn between volumes.");
  app.option("--until", "CONDITIONS", o.until,
             "Print a stop event and end when all hold: missing and overcure in per cent, iou, cured in mm3.");
  app.option("--log", "FILE", o.log, "A line of JSON for every volume; - is standard output.");
  app.option("--page", "FILE.html", o.page, "A page that shows --projections and renews itself.");
  cli::add_printer(app, o.printer);
  app.group("Output and machine");
  cli::add_report(app, o.report);
  cli::add_threads(app);

  cli::App& threshold =
      app.subcommand("threshold", "find the gelation threshold from a printed standard cylinder", o.command);
  threshold.positional("SCATTER", o.scatter, "Scattering volume of the standard (VDB).");
  threshold.option("-o,--output", "FILE.json", o.record, "Record for --resin; - is standard output.");
  threshold.option("--diameter", "MM", o.diameter_mm, cli::positive, "Known diameter of the standard.");
  threshold.option("--profile", "FILE.png", o.profile,
                   "Profilometer's height picture of the standard, to measure it on.");
  threshold.option("--profile-pixel", "MM", o.profile_pixel_mm, cli::positive, "Pixel of that picture.");
}

model::Volume dense(const io::SparseVolume& sparse) {
  model::Volume volume{sparse.grid(), std::vector<float>(sparse.grid().size())};
  sparse.read_slices(0, volume.grid.nz, volume.values.data());
  return volume;
}

std::optional<double> level_of(const Options& o) {
  if (o.level || o.resin_record.empty()) return o.level;
  try {
    return Json::parse(io::read_all(o.resin_record)).at("level").get<double>();
  } catch (const Json::exception& error) {
    throw Error{Fault::data, o.resin_record + ": not a record of vam-ost threshold (" + error.what() + ")"};
  }
}

/// One run: the views' corrections, the rig, and what is written for every volume.
class Run {
 public:
  Run(const cli::App& app, const Options& options)
      : app_(app),
        options_(options),
        printer_(io::load_printer(options.printer.file, options.printer.sets)),
        level_(level_of(options)) {
    if (!options.dark.empty()) fields_.dark = io::read_field(options.dark);
    if (!options.flat.empty()) {
      fields_.flat = io::read_field(options.flat);
      if (!fields_.dark.values.empty() && fields_.dark.size() == fields_.flat.size()) {
        for (std::size_t i = 0; i < fields_.flat.size(); ++i) fields_.flat.values[i] -= fields_.dark.values[i];
      }
    }
    if (!options.reference.empty()) reference_ = dense(io::read_volume(options.reference, ""));
    if (!level_ && (!options.mesh.empty() || !options.until.empty()))
      throw Error{Fault::usage, "--mesh and --until: need the threshold, --level or --resin"};
    if (!options.until.empty() && !reference_) throw Error{Fault::usage, "--until: needs the design, --reference"};
  }

  metrology::View take(const io::CameraFrame& frame) {
    metrology::require_exposed(frame.image, frame.name);
    metrology::View view{metrology::corrected(frame.image, fields_, options_.binning, frame.name), frame.angle_deg};
    if (width_ == 0) {
      width_ = view.image.width;
      height_ = view.image.height;
    }
    if (view.image.width != width_ || view.image.height != height_) {
      throw Error{Fault::data, frame.name + ": " + std::to_string(view.image.width) + " x " +
                                   std::to_string(view.image.height) +
                                   " pixels after binning, but the first frame has " + std::to_string(width_) + " x " +
                                   std::to_string(height_)};
    }
    return view;
  }

  model::Volume reconstruct(std::span<const metrology::View> views, double stack_pixel_mm) {
    if (!rig_) set_up(views, stack_pixel_mm);
    return rig_->reconstruct(views);
  }

  void write(const model::Volume& volume, const std::string& path, const std::vector<std::string>& history) {
    io::SparseVolume sparse("scatter", volume.grid);
    sparse.history = history;
    sparse.history.push_back(app_.history());
    sparse.units = "view units per mm";
    sparse.write_slices(0, volume.grid.nz, volume.values.data());
    io::write_volume(path, sparse);
  }

  void write_print(const model::Volume& volume) {
    if (!options_.mesh.empty()) {
      const auto mesh = solid::isosurface(volume, *level_);
      if (mesh.triangles.empty())
        throw Error{Fault::data, "no print at this threshold: nothing scatters " + format_number(*level_) + " or more"};
      const bool stl = options_.mesh.size() > 4 && options_.mesh.substr(options_.mesh.size() - 4) == ".stl";
      stl ? io::write_stl(options_.mesh, mesh) : io::write_ply(options_.mesh, mesh, {}, {app_.history()});
    }
    if (options_.projections.empty()) return;
    const auto sheet = metrology::projection_sheet(volume, level_, reference_ ? &*reference_ : nullptr);
    io::ImageFigure figure;
    figure.title = "Sum projections";
    for (std::size_t i = 0; i < sheet.images.size(); ++i)
      figure.panels.push_back({sheet.images[i], sheet.captions[i], {}});
    figure.x = {"mm", 0, sheet.images[0].width * sheet.pixel_mm};
    figure.y = {"mm", 0, sheet.images[0].height * sheet.pixel_mm};
    figure.value_label = "relative sum";
    figure.pixel_mm = sheet.pixel_mm;
    io::write_png(options_.projections, io::draw(figure));
  }

  [[nodiscard]] Json figures(const model::Volume& volume) const {
    const auto& a = axis_;
    Json json{{"axis_column_px", a.pose.column},
              {"axis_column_sigma_px", a.column_sigma},
              {"axis_tilt_deg", a.pose.tilt_rad * deg_per_rad},
              {"axis_tilt_sigma_deg", a.tilt_sigma_rad * deg_per_rad},
              {"voxel_mm", volume.grid.voxel_mm},
              {"size_voxels", {volume.grid.nx, volume.grid.ny, volume.grid.nz}}};
    if (level_) json["level"] = *level_;
    if (level_ && reference_) json["print"] = metrology::to_json(metrology::cured(volume, *level_, *reference_));
    return json;
  }

  [[nodiscard]] std::optional<metrology::Cured> state(const model::Volume& volume) const {
    if (!level_ || !reference_) return std::nullopt;
    return metrology::cured(volume, *level_, *reference_);
  }

 private:
  void set_up(std::span<const metrology::View> views, double stack_pixel_mm) {
    if (!options_.axis_column || !options_.tilt_deg) axis_ = metrology::find_axis(metrology::mean_view(views));
    if (options_.axis_column) axis_.pose.column = *options_.axis_column;
    if (options_.tilt_deg) axis_.pose.tilt_rad = *options_.tilt_deg * rad_per_deg;
    const double pixel_mm = options_.pixel_mm.value_or(stack_pixel_mm > 0 ? stack_pixel_mm : printer_.camera.pixel_mm);
    metrology::OstOptions how = options_.how;
    how.refraction = !options_.no_refraction;
    how.non_negative = !options_.keep_negative;
    rig_ = std::make_unique<metrology::OstReconstructor>(printer_, pixel_mm * options_.binning, width_, height_,
                                                         axis_.pose, how);
    note("axis at column " + format_number(axis_.pose.column, 6) + " +- " + format_number(axis_.column_sigma, 2) +
         " px, tilt " + format_number(axis_.pose.tilt_rad * deg_per_rad, 3) + " +- " +
         format_number(axis_.tilt_sigma_rad * deg_per_rad, 2) + " deg");
  }

  const cli::App& app_;
  const Options& options_;
  model::Printer printer_;
  std::optional<double> level_;
  metrology::CameraFields fields_;
  std::optional<model::Volume> reference_;
  metrology::AxisEstimate axis_;
  std::unique_ptr<metrology::OstReconstructor> rig_;
  int width_ = 0;
  int height_ = 0;
};

void once(const cli::App& app, const Options& options) {
  Run run(app, options);
  io::ViewSource source(options.views, options.step_deg);
  std::vector<metrology::View> views;
  io::CameraFrame frame;
  while (source.next(frame)) views.push_back(run.take(frame));
  const model::Volume volume = run.reconstruct(views, source.pixel_mm());
  run.write_print(volume);
  run.write(volume, options.output, source.history());
  io::write_report(options.report, "vam-ost/1", run.figures(volume));
}

void write_page(const Options& options) {
  if (options.page.empty()) return;
  io::OutputFile page(options.page, io::Content::text);
  const std::string picture = std::filesystem::path(options.projections).filename().string();
  page.write(
      "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"2\"><title>vam-ost</title>"
      "<body style=\"margin:0;background:#fff\"><img src=\"" +
      picture + "\" style=\"max-width:100%\">\n");
  page.commit();
}

void live(const cli::App& app, const Options& options) {
  std::vector<model::Condition> conditions;
  if (!options.until.empty()) conditions = model::parse_conditions(options.until, metrology::cured_names());
  if (!options.page.empty() && options.projections.empty())
    throw Error{Fault::usage, "--page: needs --projections, the picture that it shows"};
  Run run(app, options);
  const bool keep = options.output != "-";
  if (keep) std::filesystem::create_directories(options.output);
  const auto log = io::open_log(options.log);
  io::ViewSource source(options.views, options.step_deg);
  metrology::SlidingTurn turn(options.every_deg);
  io::CameraFrame frame;
  for (int index = 0; source.next(frame);) {
    if (!turn.push(run.take(frame))) continue;
    const model::Volume volume = run.reconstruct(turn.views(), source.pixel_mm());
    char name[32];
    std::snprintf(name, sizeof name, "scatter-%04d.vdb", index++);
    if (keep) run.write(volume, (std::filesystem::path(options.output) / name).string(), source.history());
    run.write_print(volume);
    write_page(options);
    Json line{{"turns", turn.turns()}, {"time_s", frame.time_s}};
    const auto state = run.state(volume);
    if (state) line.update(metrology::to_json(*state));
    if (log) io::log_line(*log, line.dump());
    if (conditions.empty() || !state) continue;
    if (!model::unmet(conditions, [&](const std::string& wanted) { return metrology::figure(*state, wanted); }).empty())
      continue;
    line["event"] = "stop";
    line["condition"] = options.until;
    std::puts(line.dump().c_str());
    break;
  }
}

void threshold(const Options& options) {
  if (options.diameter_mm.has_value() == !options.profile.empty()) {
    throw Error{Fault::usage, "threshold: give the standard's size, either --diameter or --profile"};
  }
  double diameter_mm = options.diameter_mm.value_or(0);
  if (!options.profile.empty())
    diameter_mm = 2 * options.profile_pixel_mm * metrology::find_circle(io::read_field(options.profile)).radius;
  const model::Volume volume = dense(io::read_volume(options.scatter, ""));
  Image overhead = metrology::sum_projections(volume).along_z;
  const auto height_mm = static_cast<float>(volume.grid.nz * volume.grid.voxel_mm);
  for (float& value : overhead.values) value /= height_mm;
  Json figures = metrology::to_json(metrology::gelation_threshold(overhead, volume.grid.voxel_mm, diameter_mm));
  io::write_report(options.record, "vam-resin/1", figures);
}

void run(const cli::App& app, const Options& options) {
  if (options.printer.print) {
    std::fputs(io::printer_toml(io::load_printer(options.printer.file, options.printer.sets)).c_str(), stdout);
    return;
  }
  if (options.command == "threshold") return threshold(options);
  options.live ? live(app, options) : once(app, options);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
