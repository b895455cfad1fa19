// vam-view: images of volumes, stacks, videos and folders, for inspection.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/file_type.hpp"
#include "io/vdb/nrrd.hpp"
#include "model/circle.hpp"
#include "model/dose_metrics.hpp"
#include "optics/writable_radius.hpp"
#include "plot/save.hpp"
#include "plot/view.hpp"
#include "printer.hpp"
#include "vam-view/options.hpp"

namespace {

using namespace vam;
using view_tool::Options;

void write_figure(const Options& options, const plot::ImageFigure& figure, const std::string& history) {
  if (!options.plain) return plot::save(options.output, plot::draw(figure), history, options.dpi);
  io::write_png(options.output, plot::coloured(figure.panels.front().values, figure.scale), {{"Comment", history}});
}

io::SparseVolume target_for(const Options& options) {
  return io::read_volume(options.target.empty() ? options.input : options.target, "target");
}

bool has_grid(const std::string& path, const std::string& name) {
  if (path == "-") return false;  // can be read once only
  const std::vector<io::VolumeFacts> grids = io::check_volumes(path, true);
  return std::any_of(grids.begin(), grids.end(), [&](const io::VolumeFacts& facts) { return facts.name == name; });
}

/// A target is shown with its insert.
std::string grid_of(const Options& options) {
  if (!options.grid.empty()) return options.grid;
  if (options.histogram) return "dose";
  return has_grid(options.input, "target") && has_grid(options.input, "insert") ? "target" : "";
}

void show_sections(const Options& options, const io::SparseVolume& volume, const std::string& history) {
  std::optional<io::SparseVolume> target;
  std::optional<io::SparseVolume> insert;
  if (!options.target.empty()) target.emplace(target_for(options));
  const std::string& with = options.target.empty() ? options.input : options.target;
  if (volume.name() != "insert" && has_grid(with, "insert")) insert.emplace(io::read_volume(with, "insert"));
  write_figure(options,
               plot::view_volume(volume, target ? &*target : nullptr, options.view, insert ? &*insert : nullptr),
               history);
}

void show_volume(const Options& options, const std::string& history) {
  const io::SparseVolume volume = io::read_volume(options.input, grid_of(options));
  if (!options.exported.empty()) return io::write_nrrd(options.exported, volume);
  if (options.histogram) {
    const model::Printer printer = tool::load_printer(options.printer);
    io::SparseVolume target = target_for(options);
    target.extend_to(volume.grid());
    const double farthest_mm = io::farthest_mm(target, model::coverage_rounding);
    const auto circle = model::writable_circle(volume.grid(), optics::judged_radius_mm(printer, farthest_mm));
    return plot::save(options.output, plot::draw(plot::dose_histogram(volume, target, circle, options.view)), history,
                      options.dpi);
  }
  show_sections(options, volume, history);
}

void show_images(const Options& options, io::FileType type, const std::string& history) {
  if (options.histogram || !options.target.empty()) {
    throw Error{Fault::data, options.input + ": --dose-histogram and --target require a volume (VDB), not images"};
  }
  if (!options.exported.empty()) {
    if (type != io::FileType::stack) throw Error{Fault::usage, "--export: requires a volume or an EXR stack"};
    io::StackReader stack(options.input);
    return io::write_nrrd(options.exported, stack);
  }
  const auto images = io::open_images(options.input, type);
  write_figure(options, plot::view_images(*images, options.view), history);
}

void run(const cli::App& app, Options& options) {
  if (tool::print_printer(options.printer)) return;
  check(options);
  if (app.given("--title")) options.view.title = options.title;
  options.view.name = options.input == "-" ? "stdin" : options.input.substr(options.input.find_last_of('/') + 1);
  options.view.plane = options.plane == "axial"     ? plot::Plane::axial
                       : options.plane == "coronal" ? plot::Plane::coronal
                                                    : plot::Plane::sagittal;
  const io::FileType type = io::file_type(options.input);
  if (type == io::FileType::volume) return show_volume(options, app.history());
  show_images(options, type, app.history());
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(view_tool::manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
