// SPDX-License-Identifier: GPL-3.0-or-later
// vam-view: figures of volumes, stacks, videos, folders, meshes and traces.
#include <string>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "manual_page.hpp"
#include "model/metadata.hpp"
#include "plot/save.hpp"
#include "plot/view.hpp"
#include "session/dose_score.hpp"
#include "session/grey_target.hpp"
#include "session/printer.hpp"
#include "session/volumes.hpp"
#include "vam-view/figures.hpp"
#include "vam-view/options.hpp"

namespace {

using namespace vam;
using session::Companions;
using view_tool::Options;

void write_figure(const Options& options, const plot::ImageFigure& figure, const std::string& history) {
  if (!options.plain) return plot::save(options.output, plot::draw(figure), history, options.dpi);
  const plot::Panel& panel = figure.panels.front();
  const RgbImage pixels = panel.picture.values.empty() ? plot::coloured(panel.values, figure.scale) : panel.picture;
  io::write_png(options.output, pixels, {{"Comment", history}});
}

/// Whether doses are held against the part.
bool judges(const Options& options) {
  return options.histogram || options.cure || (options.render && !options.target.empty());
}

/// Of a file with several grids: doses where one is judged, else a target, which is shown with its insert.
std::string grid_of(const Options& options, const Companions& shown) {
  if (!options.grid.empty()) return options.grid;
  if (judges(options)) return "dose";
  return shown.has("target") && shown.has("insert") ? "target" : "";
}

constexpr const char* grey_remedy = "a target that is the dose of every voxel is judged by vam-score --grey-target";

/// How the volume is judged as a dose, on whose grid the target is from now on.
score::ScoreOptions judged(const Options& options, Companions& shown) {
  io::check_values(shown.file(), shown.target());  // doses below 0 are looked at
  const io::SparseVolume& target = shown.target_around();
  session::warn_of_grey(target, shown.file(), grey_remedy);
  score::ScoreOptions how;
  how.threshold = options.threshold;
  session::resolve_exposure(
      how, shown.volume(), target,
      session::printer_of(options.printer, shown.volume().metadata, io::input_name(options.input)));
  return how;
}

/// Throws Fault::data where the doses give none.
double threshold_of(const Options& options, const score::Score& result) {
  const double found = result.print_threshold();
  if (found > 0) return found;
  (void)result.figures();  // refuses a part without voxels, and doses of 0
  throw Error{Fault::data, io::input_name(options.input) +
                               ": no threshold follows from the doses, as part of the part receives none; give "
                               "--isovalue, or compute the projections again"};
}

bool is_movie(const Options& options) { return options.output.ends_with(".mp4"); }

void write_movie(const Options& options, Companions& shown, const std::string& history) {
  const io::SparseVolume& dose = shown.volume();
  const score::ScoreOptions how = judged(options, shown);
  view_tool::Exposure exposure;
  const auto turns = model::stated_number(dose.metadata, "vam:print_turns");
  const auto seconds = model::stated_number(dose.metadata, "vam:print_s");
  if (turns && seconds) exposure.duration = {*turns, *seconds};
  if (options.threshold) {
    exposure.threshold = *options.threshold;
  } else {
    const score::Score result = session::score_volumes(dose, shown.target(), how);
    exposure.threshold = threshold_of(options, result);
    const auto plan = how.threshold ? std::nullopt : result.plan();  // for the dose of one turn
    if (plan) exposure.duration = {static_cast<double>(plan->turns), plan->seconds};
  }
  view_tool::write_movie(options.output, dose, shown.target(), shown.insert(), exposure, options.view, options.dpi,
                         history);
}

plot::ImageFigure volume_figure(const Options& options, Companions& shown) {
  const io::SparseVolume& volume = shown.volume();
  if (judges(options)) {
    const score::ScoreOptions how = judged(options, shown);
    const io::SparseVolume& target = shown.target();
    const double threshold =
        options.threshold ? *options.threshold : threshold_of(options, session::score_volumes(volume, target, how));
    if (!options.cure) return view_tool::print_figure(volume, target, threshold, options.view, shown.insert());
    return plot::view_cure(volume, target, threshold, how.circle, options.view, shown.insert());
  }
  if (options.render)
    return view_tool::body_figure(volume, options.threshold.value_or(0.5), options.view, shown.insert());
  if (!options.compare.empty()) {
    std::vector<Companions> files;
    std::vector<plot::OtherVolume> others;
    files.reserve(options.compare.size());
    const std::vector<std::string> names = file_names(options);
    for (const std::string& path : options.compare)
      others.push_back({&files.emplace_back(path, "", std::nullopt).choose(volume.name()), names[files.size()]});
    return plot::view_difference(volume, others, options.target.empty() ? nullptr : &shown.target(), options.view);
  }
  return plot::view_volume(volume, options.target.empty() ? nullptr : &shown.target(), options.view, shown.insert());
}

void show_volume(Options options, const std::string& history) {
  Companions shown(options.input, options.target, {});
  shown.choose(grid_of(options, shown));
  options.view.stretch_z = model::stretch_z(shown.volume().metadata);
  if (!options.exported.empty()) return io::write_nrrd(options.exported, shown.volume());
  if (options.histogram) {
    const score::ScoreOptions how = judged(options, shown);
    options.view.critical = how.threshold;
    const plot::Plot plot =
        plot::dose_histogram(shown.volume(), shown.target(), how.circle, options.view, shown.insert());
    return plot::save(options.output, plot::draw(plot), history, options.dpi);
  }
  if (is_movie(options)) return write_movie(options, shown, history);
  plot::ImageFigure figure = volume_figure(options, shown);
  if (options.crop == "part") plot::crop_to_part(figure, shown.target_around(), options.view.plane);
  write_figure(options, figure, history);
}

void show_images(const cli::App& app, Options options, io::FileType type) {
  if (!options.exported.empty()) {
    io::StackReader stack(options.input);
    return io::write_nrrd(options.exported, stack);
  }
  const auto images = io::open_images(options.input, type);
  options.view.stretch_z = model::stretch_z(images->info().extra);
  write_figure(options, plot::view_images(*images, options.view), app.history());
}

constexpr const char* trace_ending = ".csv";

/// As options say what they are not for.
std::string kind_of(const std::string& input, const std::optional<io::FileType>& type) {
  if (!type) return input.ends_with(trace_ending) ? "traces" : "meshes";
  return *type == io::FileType::volume ? "volumes" : *type == io::FileType::stack ? "stacks" : "images";
}

/// A trace of vam-optimize, or else a mesh.
void show_other(const cli::App& app, const Options& options) {
  if (!options.input.ends_with(trace_ending))
    return write_figure(options, view_tool::mesh_figure(options.input, options.view), app.history());
  plot::save(options.output, plot::draw(view_tool::trace_plot(options)), app.history(), options.dpi);
}

void run(const cli::App& app, Options& options) {
  if (session::print_printer(options.printer)) return;
  const auto& view = options.view;
  if (view.low && view.high && *view.low >= *view.high)
    throw Error{Fault::usage,
                "--low " + format_number(*view.low) + ": must be below --high " + format_number(*view.high)};
  if (app.given("--title")) options.view.title = options.title;
  options.view.name = file_names(options).front();
  options.view.crop = !options.plain;
  options.view.plane = options.plane == "axial"     ? plot::Plane::axial
                       : options.plane == "coronal" ? plot::Plane::coronal
                                                    : plot::Plane::sagittal;
  const auto type = io::known_file_type(options.input);
  app.require_for(kind_of(options.input, type), io::input_name(options.input));
  if (!type) return show_other(app, options);
  if (options.plain) app.require_for("plain pixels", io::input_name(options.input));
  if (*type == io::FileType::volume) return show_volume(options, app.history());
  show_images(app, options, *type);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-view", "draw volumes, sinograms, frames, videos, meshes and traces as figures", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
