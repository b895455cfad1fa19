// SPDX-License-Identifier: GPL-3.0-or-later
// vam-score: scores a dose against its target.
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "io/exr/stack.hpp"
#include "io/mesh/file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "manual_page.hpp"
#include "model/conditions.hpp"
#include "model/grid.hpp"
#include "model/metadata.hpp"
#include "model/printer.hpp"
#include "optics/lit_fraction.hpp"
#include "score/score.hpp"
#include "session/dose_score.hpp"
#include "session/exposure.hpp"
#include "session/grey_target.hpp"
#include "session/printer.hpp"
#include "session/surface.hpp"
#include "session/volumes.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-score/options.hpp"

namespace vam::score_tool {

namespace {

/// To --mesh. Throws Fault::data when nothing prints at this dose.
void write_print(const Options& options, const io::SparseVolume& dose, double threshold) {
  const auto require_print = [&](bool empty) {
    if (!empty) return;
    throw Error{Fault::data, "nothing prints at a dose of " + format_number(threshold) + " " + dose.units +
                                 "; choose an --isovalue below the largest dose"};
  };
  const std::vector<std::string> comments{"threshold dose " + format_number(threshold) + " " + dose.units};
  if (options.print_as == "mesh") {
    const auto mesh = session::fine_surface(dose, threshold, dose.metadata);
    require_print(mesh.triangles.empty());
    for (const std::string& ending : io::written_mesh_endings())
      if (options.print.ends_with(ending)) return io::write_mesh(options.print, mesh, comments);
    return io::write_ply(options.print, mesh, {}, comments);  // of another name, as of a device
  }
  auto print = solid::printed_points(
      dose.grid(), [&](int k, int count, float* out) { dose.read_slices(k, count, out); }, threshold);
  require_print(print.points.points.empty());
  model::unstretch(print.points, dose.metadata);
  io::write_ply(options.print, print.points, print.values, comments);
}

/// By distance from the axis, in steps of half a voxel, up to the resin's edge.
std::vector<double> fractions_by_radius(const model::Printer& printer, double step_mm) {
  std::vector<double> radii_mm(static_cast<std::size_t>(model::resin_radius_mm(printer.vial) / step_mm) + 1);
  for (std::size_t i = 0; i < radii_mm.size(); ++i) radii_mm[i] = static_cast<double>(i) * step_mm;
  return optics::lit_fractions(printer, radii_mm);
}

/// Writes the grid 'lit_fraction' over those voxels: the fraction of stage angles [0, 1] from which the projector
/// lights each (optics::lit_fraction); 0 outside the resin. The line of `app` is its history.
void write_lit_fraction(const std::string& path, const model::Grid& grid, const model::Printer& printer,
                        const cli::App& app) {
  const double step_mm = 0.5 * grid.voxel_mm;
  const std::vector<double> fractions = fractions_by_radius(printer, step_mm);
  std::vector<float> slice(grid.slice_size());
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const auto at = static_cast<std::size_t>(std::hypot(grid.x_mm(i), grid.y_mm(j)) / step_mm + 0.5);
      if (at < fractions.size()) slice[product(j, grid.nx) + i] = static_cast<float>(fractions[at]);
    }
  }
  io::SparseVolume volume("lit_fraction", grid);
  for (int k = 0; k < grid.nz; ++k) volume.write_slices(k, 1, slice.data());
  volume.units = "fraction of stage angles";
  volume.history.push_back(app.history());
  io::write_volume(path, volume);
}

}  // namespace

}  // namespace vam::score_tool

namespace {

using namespace vam;
using score_tool::Options;

void add_light(score::Score& result, const std::string& sinogram) {
  io::StackReader light(sinogram);
  Image image;
  for (model::ImageInfo about; light.next(image, about);) result.add_projection(image.values);
}

/// Conditions must be on figures that the inputs determine.
void require_known(const std::vector<model::Condition>& conditions, const Options& options) {
  const score::ScoreOptions& how = options.how;
  for (const model::Condition& condition : conditions) {
    const std::string subject = "--require " + condition.name + ": ";
    if (condition.name.starts_with("cured_") && !how.threshold && !how.exposure) {
      throw Error{Fault::usage, subject +
                                    "the critical dose is not known; give --critical-dose, or set "
                                    "resin.critical_dose_mj_cm3 and score a dose in mJ/cm3"};
    }
    if (score::is_of_exposure(condition.name) && !how.exposure) {
      throw Error{Fault::usage,
                  subject + "the exposure is not known; set resin.critical_dose_mj_cm3 and score a dose in mJ/cm3"};
    }
    if (condition.name == "efficiency" && options.sinogram.empty()) {
      throw Error{Fault::usage, subject + "requires the projections; give --sinogram"};
    }
  }
}

void require_files_for_outputs(const Options& options) {
  for (const auto& output : {options.print, options.lit_fraction}) {
    if (output != "-") continue;
    throw Error{Fault::usage,
                "--mesh, --lit-fraction: standard output holds the figures of merit; give a file instead of -"};
  }
}

std::vector<model::Condition> conditions_of(const Options& options) {
  if (options.require.empty()) return {};
  return model::parse_conditions(options.require,
                                 options.grey.is_target ? score::GreyScore::names() : score::Score::names());
}

void score_grey(const Options& options, const std::vector<model::Condition>& conditions) {
  session::Companions in(options.input, options.target, io::TargetKind::grey);
  const io::SparseVolume& dose = in.choose(options.grid);
  const model::Printer printer = session::printer_of(options.printer, dose.metadata, io::input_name(options.input));
  const score::GreyScore result =
      session::score_grey(dose, in.target_around(), options.grey, in.tolerance(), printer, options.input);
  io::write_report(options.report, "vam-score-grey", result.figures());
  if (options.report != "-") io::write_text("-", result.table());
  model::require_met(conditions, [&](const std::string& name) { return result.figure(name); });
}

void run(const cli::App& app, Options& options) {
  const std::vector<model::Condition> conditions = conditions_of(options);
  if (session::print_printer(options.printer)) return;
  if (options.grey.is_target) return score_grey(options, conditions);
  require_files_for_outputs(options);
  session::Companions in(options.input, options.target, io::TargetKind::coverage);
  const io::SparseVolume& dose = in.choose(options.grid);
  const io::SparseVolume& target = in.target_around();
  const model::Printer printer = session::printer_of(options.printer, dose.metadata, io::input_name(options.input));
  session::warn_of_grey(target, in.file());
  options.how.target = io::input_name(in.file());
  session::resolve_exposure(options.how, dose, target, printer);
  require_known(conditions, options);
  score::Score result = session::score_print(dose, target, options.how);
  if (!options.sinogram.empty()) add_light(result, options.sinogram);
  const Json figures = result.figures();
  if (!options.lit_fraction.empty()) score_tool::write_lit_fraction(options.lit_fraction, target.grid(), printer, app);
  if (!options.print.empty())
    score_tool::write_print(options, dose, options.print_at.value_or(result.print_threshold()));
  io::write_report(options.report, "vam-score", figures);
  if (options.report != "-") {
    const std::string sinogram = options.sinogram.empty() ? "SINOGRAM" : options.sinogram;
    const bool stated = model::stated_text(dose.metadata, "vam:dose_of") == "stated";
    const std::string how = session::how_to_show(printer.resin, stated, sinogram, options.printer);
    io::write_text("-", result.table(options.grid == "dose" ? how : ""));
  }
  model::require_met(conditions, [&](const std::string& name) { return result.figure(name); });
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-score", "score a dose against its target", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
