// SPDX-License-Identifier: GPL-3.0-or-later
// vam-view: figures of volumes, stacks, videos, folders, meshes and traces.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/input_name.hpp"
#include "io/vdb/nrrd.hpp"
#include "manual_page.hpp"
#include "model/metadata.hpp"
#include "plot/save.hpp"
#include "plot/view.hpp"
#include "session/dose_score.hpp"
#include "session/grey_target.hpp"
#include "session/printer.hpp"
#include "vam-view/bodies.hpp"
#include "vam-view/movie.hpp"
#include "vam-view/options.hpp"
#include "vam-view/trace.hpp"

namespace {

using namespace vam;
using view_tool::Options;

void write_figure(const Options& options, const plot::ImageFigure& figure, const std::string& history) {
  if (!options.plain) return plot::save(options.output, plot::draw(figure), history, options.dpi);
  const plot::Panel& panel = figure.panels.front();
  const RgbImage pixels = panel.picture.values.empty() ? plot::coloured(panel.values, figure.scale) : panel.picture;
  io::write_png(options.output, pixels, {{"Comment", history}});
}

bool has_grid(const std::string& path, const std::string& name) {
  if (path == "-") return false;  // can be read once only
  const std::vector<io::VolumeFacts> grids = io::check_volumes(path, true);
  return std::any_of(grids.begin(), grids.end(), [&](const io::VolumeFacts& facts) { return facts.name == name; });
}

io::SparseVolume target_for(const Options& options) {
  if (!options.target.empty()) return io::read_volume(options.target, "target");
  if (options.input != "-" && !has_grid(options.input, "target"))
    throw Error{Fault::data, options.input + ": has no grid 'target'; give the part with --target"};
  return io::read_volume(options.input, "target");
}

/// A target is shown with its insert.
std::string grid_of(const Options& options) {
  if (!options.grid.empty()) return options.grid;
  if (options.histogram || options.cure || (options.render && !options.target.empty())) return "dose";
  return has_grid(options.input, "target") && has_grid(options.input, "insert") ? "target" : "";
}

/// On the grid of the volume, if the file of the target has one.
std::optional<io::SparseVolume> insert_for(const Options& options, const io::SparseVolume& volume) {
  const std::string& with = options.target.empty() ? options.input : options.target;
  if (volume.name() == "insert" || !has_grid(with, "insert")) return std::nullopt;
  io::SparseVolume insert = io::read_volume(with, "insert");
  insert.extend_to(volume.grid(), with);
  return insert;
}

plot::ImageFigure sections(const Options& options, const io::SparseVolume& volume) {
  std::optional<io::SparseVolume> target;
  const std::optional<io::SparseVolume> insert = insert_for(options, volume);
  if (!options.target.empty()) target.emplace(target_for(options));
  return plot::view_volume(volume, target ? &*target : nullptr, options.view, insert ? &*insert : nullptr);
}

constexpr const char* grey_remedy = "a target that is the dose of every voxel is judged by vam-score --grey-target";

/// With the target around the dose, and how it is judged.
struct Judged {
  io::SparseVolume target;
  score::ScoreOptions how;
};

Judged judged(const Options& options, const io::SparseVolume& dose) {
  Judged made{target_for(options), {}};
  session::warn_of_grey(made.target, options.target.empty() ? options.input : options.target, grey_remedy);
  made.target.extend_to(dose.grid(), options.target.empty() ? options.input : options.target);
  made.how.threshold = options.threshold;
  session::resolve_exposure(made.how, dose, made.target, session::load_printer(options.printer));
  return made;
}

/// Throws Fault::data where the doses give none.
double threshold_of(const Options& options, const score::Score& result) {
  const double found = result.print_threshold();
  if (found > 0) return found;
  (void)result.figures();  // refuses a part without voxels, and doses of 0
  throw Error{Fault::data, io::input_name(options.input) +
                               ": no threshold follows from the doses, as part of the part receives none; give "
                               "--threshold, or compute the projections again"};
}

bool is_movie(const Options& options) { return options.output.ends_with(".mp4"); }

void write_movie(const Options& options, const io::SparseVolume& dose, const std::string& history) {
  const Judged with = judged(options, dose);
  view_tool::Exposure exposure;
  const auto turns = model::stated_number(dose.metadata, "vam:print_turns");
  const auto seconds = model::stated_number(dose.metadata, "vam:print_s");
  if (turns && seconds) exposure.duration = {*turns, *seconds};
  if (options.threshold) {
    exposure.threshold = *options.threshold;
  } else {
    const score::Score result = session::score_volumes(dose, with.target, with.how);
    exposure.threshold = threshold_of(options, result);
    const auto plan = with.how.threshold ? std::nullopt : result.plan();  // for the dose of one turn
    if (plan) exposure.duration = {static_cast<double>(plan->turns), plan->seconds};
  }
  const std::optional<io::SparseVolume> insert = insert_for(options, dose);
  view_tool::write_movie(options.output, dose, with.target, insert ? &*insert : nullptr, exposure, options.view,
                         options.dpi, history);
}

plot::ImageFigure volume_figure(const Options& options, const io::SparseVolume& volume) {
  std::optional<io::SparseVolume> held;
  if (options.cure || options.render) held = insert_for(options, volume);
  const io::SparseVolume* insert = held ? &*held : nullptr;
  if (options.cure || (options.render && !options.target.empty())) {
    const Judged with = judged(options, volume);
    const double threshold = options.threshold
                                 ? *options.threshold
                                 : threshold_of(options, session::score_volumes(volume, with.target, with.how));
    if (!options.cure) return view_tool::print_figure(volume, with.target, threshold, options.view, insert);
    return plot::view_cure(volume, with.target, threshold, with.how.circle, options.view, insert);
  }
  if (options.render) return view_tool::body_figure(volume, options.threshold.value_or(0.5), options.view, insert);
  if (!options.compare.empty()) {
    const io::SparseVolume other = io::read_volume(options.compare, volume.name());
    return plot::view_difference(volume, other, view_tool::file_name(options.compare, options.input), options.view);
  }
  return sections(options, volume);
}

void show_volume(Options options, const std::string& history) {
  const io::SparseVolume volume = io::read_volume(options.input, grid_of(options));
  options.view.stretch_z = model::stretch_z(volume.metadata);
  if (!options.exported.empty()) return io::write_nrrd(options.exported, volume);
  if (options.histogram) {
    const Judged with = judged(options, volume);
    const std::optional<io::SparseVolume> insert = insert_for(options, volume);
    const plot::Plot plot =
        plot::dose_histogram(volume, with.target, with.how.circle, options.view, insert ? &*insert : nullptr);
    return plot::save(options.output, plot::draw(plot), history, options.dpi);
  }
  if (is_movie(options)) return write_movie(options, volume, history);
  write_figure(options, volume_figure(options, volume), history);
}

/// Options that only other kinds of files have a use for.
void refuse(const cli::App& app, const Options& options, const std::string& what,
            const std::vector<std::string>& flags) {
  for (const std::string& flag : flags) {
    if (app.given(flag))
      throw Error{Fault::data, options.input + ": " + flag + " does not apply to " + what + "; omit it"};
  }
}

/// Of a volume, those that another figure has a use for.
void refuse_unused(const cli::App& app, const Options& options) {
  const std::vector<std::string> of_sections{"--plane", "--at", "--sheet"};
  if (options.histogram) {
    refuse(app, options, "a histogram", of_sections);
    refuse(app, options, "a histogram", {"--colours"});
  }
  if (options.render) refuse(app, options, "a body in three dimensions", of_sections);
  if (options.render || options.cure) refuse(app, options, "colours that tell cure", {"--colours", "--low", "--high"});
  if (options.plain) refuse(app, options, "plain pixels", {"--dpi", "--title"});
}

void show_images(const cli::App& app, Options options, io::FileType type) {
  refuse(app, options, "images",
         {"--grid", "--plane", "--target", "--dose-histogram", "--cure-map", "--render", "--threshold", "--compare"});
  if (!options.exported.empty()) {
    if (type != io::FileType::stack) throw Error{Fault::usage, "--export: requires a volume or an EXR stack"};
    io::StackReader stack(options.input);
    return io::write_nrrd(options.exported, stack);
  }
  const auto images = io::open_images(options.input, type);
  options.view.stretch_z = model::stretch_z(images->info().extra);
  write_figure(options, plot::view_images(*images, options.view), app.history());
}

/// A trace of vam-optimize, or else a mesh.
void show_other(const cli::App& app, const Options& options) {
  if (!options.exported.empty()) throw Error{Fault::usage, "--export: requires a volume or an EXR stack"};
  const bool trace = options.input.ends_with(".csv");
  const std::string what = trace ? "a trace" : "a mesh";
  refuse(app, options, what,
         {"--grid", "--plane", "--target", "--dose-histogram", "--cure-map", "--threshold", "--at", "--sheet",
          "--colours", "--low", "--high"});
  if (!trace) {
    refuse(app, options, what, {"--compare"});
    return write_figure(options, view_tool::mesh_figure(options.input, options.view), app.history());
  }
  refuse(app, options, what, {"--render", "--plain", "--image-size"});
  plot::save(options.output, plot::draw(view_tool::trace_plot(options)), app.history(), options.dpi);
}

void run(const cli::App& app, Options& options) {
  if (session::print_printer(options.printer)) return;
  check(options);
  if (app.given("--title")) options.view.title = options.title;
  options.view.name = view_tool::file_name(options.input, options.compare);
  options.view.crop = !options.plain;
  options.view.plane = options.plane == "axial"     ? plot::Plane::axial
                       : options.plane == "coronal" ? plot::Plane::coronal
                                                    : plot::Plane::sagittal;
  const auto type = io::known_file_type(options.input);
  if (!type) return show_other(app, options);
  if (*type == io::FileType::volume) {
    refuse_unused(app, options);
    return show_volume(options, app.history());
  }
  show_images(app, options, *type);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-view", "draw volumes, sinograms, frames, videos, meshes and traces as figures", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
