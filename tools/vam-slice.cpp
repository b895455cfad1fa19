// SPDX-License-Identifier: GPL-3.0-or-later
// vam-slice: voxelises a mesh, numbered images or a shape, with fractional coverage at the surface.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/compute/memory.hpp"
#include "base/compute/slab.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "light/grids/lit_grid.hpp"
#include "manual_page.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/grid_size.hpp"
#include "model/metadata.hpp"
#include "model/printer.hpp"
#include "optics/writable_radius.hpp"
#include "session/printer.hpp"
#include "solid/shapes/shapes.hpp"
#include "solid/voxel/part.hpp"
#include "solid/voxel/size_doubt.hpp"
#include "solid/voxel/trapped_resin.hpp"
#include "vam-slice/options.hpp"
#include "vam-slice/part.hpp"

namespace {

using namespace vam;
using slice_tool::Options;

io::SparseVolume volume_of(const std::string& name, const solid::Part& part, const model::Grid& grid,
                           solid::FillSummary& content) {
  io::SparseVolume volume(name, grid);
  Progress progress("slicing", grid.nz);
  content = solid::fill(part, grid, [&](int k0, int count, const float* slices) {
    volume.write_slices(k0, count, slices);
    progress.tick(count);
  });
  solid::warn_of_repairs(part);
  return volume;
}

/// As it will be printed.
double largest_mm(const solid::Part& part, double stretch_z) {
  const solid::Point size = part.extent.box.size();
  return std::max({size[0], size[1], size[2] / stretch_z});
}

/// Whether the user has said how large the file is, or it is no file.
bool is_size_known(const cli::App& app, const solid::Part& part) {
  return !part.repair || app.given("--unit") || app.given("--scale") || app.given("--fit");
}

void judge_size(const cli::App& app, const Options& options, const solid::Part& part, const solid::FillSummary& content,
                const model::Grid& grid, const solid::Writable& room) {
  const std::string doubt =
      solid::size_doubt(part, content, grid, options.placement.stretch_z, room, is_size_known(app, part));
  // What was to fit is to be printed: vam-optimize takes no target without such a voxel.
  if (options.placement.fit_writable && !model::half_covered(content.most)) {
    throw Error{Fault::data, part.subject + ": at the size that fits, " +
                                 format_number(largest_mm(part, options.placement.stretch_z), 3) + " mm, no voxel of " +
                                 format_number(grid.voxel_mm) + " mm is at least half covered (" +
                                 format_number(static_cast<double>(content.most), 2) + " at most); use voxels of " +
                                 format_number(solid::resolving_voxel_mm(content, grid), 2) +
                                 " mm, or thicken the part"};
  }
  if (!doubt.empty()) return warn(doubt);
  for (const std::string& thin :
       solid::resolution_doubts(part.subject, content.unresolved, grid, options.placement.stretch_z))
    warn(thin);
  const bool holds_insert = !options.insert.empty() || !options.insert_shape.empty();  // which may fill the cavity
  const std::string trapped = solid::trapped_resin(content.cavities, grid.voxel_mm, options.placement.stretch_z);
  if (!trapped.empty() && !holds_insert) warn(part.subject + ": " + trapped + "; open it by a hole");
}

/// For a part that is too large.
solid::PlacementAdvice advice_for(const cli::App& app, const Options& options, const model::Printer& printer,
                                  const solid::Part& part, const solid::Writable& room) {
  solid::PlacementAdvice advice = slice_tool::advice(options);
  if (part.extent.radius_mm > model::resin_radius_mm(printer.vial)) advice.beyond.clear();
  if (is_size_known(app, part)) return advice;
  const std::string unit = solid::finer_unit(largest_mm(part, options.placement.stretch_z), room);
  if (!unit.empty()) advice.unit = unit + " --unit states it; else ";
  return advice;
}

void warn_of_insert_size(const cli::App& app, const Options& options, const solid::Part& insert,
                         const solid::Writable& room) {
  const double size_mm = largest_mm(insert, options.placement.stretch_z);
  const bool known = !insert.repair || app.given("--insert-unit") || app.given("--insert-scale");
  const std::string doubt = known ? "" : solid::unit_doubt(insert.subject, "insert", size_mm, room);
  if (!doubt.empty()) {
    warn(doubt + "; --insert-unit states it");
  } else if (size_mm < options.voxel_mm.value()) {
    warn(insert.subject + ": the insert is only " + format_number(size_mm, 3) + " mm large, less than a voxel of " +
         format_number(options.voxel_mm.value(), 3) + " mm; check --insert-unit and --insert-scale");
  }
}

void write(const cli::App& app, const Options& options, const model::Printer& printer,
           std::vector<io::SparseVolume>& volumes) {
  for (io::SparseVolume& volume : volumes) {
    volume.history.push_back(app.history());
    volume.metadata["vam:printer"] = io::printer_settings(printer);
    volume.metadata["vam:stretch_z"] = format_number(options.placement.stretch_z, 9);
  }
  io::write_volumes(options.output, volumes);
}

/// With the slices below and above in which the insert shades light that climbs to those of the grid.
model::Grid with_shade(const model::Grid& grid, const model::Printer& printer, const solid::Part& part,
                       const solid::Part& insert) {
  const double farthest_mm = std::max(part.extent.radius_mm, insert.extent.radius_mm);
  const light::Margin lit = light::lit_margin(printer, grid, optics::judged_radius_mm(printer, farthest_mm));
  const auto slices = [&](double mm, int most) {
    return static_cast<int>(std::clamp(std::ceil(mm / grid.voxel_mm), 0.0, static_cast<double>(most)));
  };
  const solid::Bounds& box = insert.extent.box;
  return light::extended(grid, {.below = slices(grid.z_mm(-0.5) - box.low[2], lit.below),
                                .above = slices(box.high[2] - grid.z_mm(grid.nz - 0.5), lit.above)});
}

/// Around the part, or the resin that may be lit, and the insert, which must fit into the vial.
model::Grid grid_of(const Options& options, const model::Printer& printer, const solid::Part& part,
                    const std::optional<solid::Part>& insert, const solid::Writable& room) {
  double radius_mm = options.extent == "part" ? 0 : room.radius_mm;
  if (insert) {
    solid::require_within(insert->extent, model::resin_radius_mm(printer.vial), insert->subject);
    radius_mm = std::max(radius_mm, insert->extent.radius_mm);
  }
  model::Grid grid = solid::grid_around(part.extent, options.voxel_mm.value(), radius_mm, part.lattice, part.subject);
  if (insert) grid = with_shade(grid, printer, part, *insert);
  // 16 slices at a time, those of the volume beside them.
  require_memory(2.0 * sizeof(float) * lanes * static_cast<double>(grid.slice_size()),
                 part.subject + ": " + model::size_text(grid), "use a larger --voxel");
  return grid;
}

void run(const cli::App& app, Options& options) {
  check(app, options);
  options.unit_given = app.given("--unit");
  options.insert_unit_given = app.given("--insert-unit");
  const model::Printer printer = session::load_printer(options.printer);
  if (session::print_printer(options.printer, printer, options.output)) return;
  resolve(options, printer);

  solid::Writable room = options.extent == "resin" ? solid::whole_resin(printer)
                                                   : solid::writable(printer, optics::writable_radius_mm(printer));
  if (options.any_height) room.low_mm = -(room.high_mm = solid::any_height_mm);
  slice_tool::Correction correction;
  solid::Part part = part_of(options, printer.projector, room, correction);
  std::optional<solid::Part> insert = insert_of(options, part, room);
  if (insert) warn_of_insert_size(app, options, *insert, room);
  if (insert) insert->surface = {};  // whether it would print is not asked
  const double lift_mm = slice_tool::lift_mm(options, printer, part, room);
  part = solid::lifted(std::move(part), lift_mm);
  if (insert) insert = solid::lifted(std::move(*insert), lift_mm);
  solid::require_writable(part.extent, room, options.voxel_mm.value(), part.subject,
                          advice_for(app, options, printer, part, room));
  const model::Grid grid = grid_of(options, printer, part, insert, room);
  if (insert && slice_tool::is_beyond(*insert, grid, options.placement.stretch_z)) insert.reset();
  solid::FillSummary content;
  std::optional<io::SparseVolume> opaque;
  solid::Part printed = part;
  if (insert) {
    opaque.emplace(volume_of("insert", *insert, grid, content));
    printed = slice_tool::around(part, *opaque, options);
  }
  std::vector<io::SparseVolume> volumes;
  volumes.push_back(volume_of("target", printed, grid, content));
  if (content.unresolved.surface) model::state_surface(volumes.front().metadata, content.unresolved.surface->places);
  solid::require_lit(content.radius_mm, room, grid.voxel_mm, part.subject, advice(options));
  judge_size(app, options, part, content, grid, room);
  Json report = solid::figures(part, content, grid, options.placement.stretch_z, room);
  report["place"] = lift_figures(options, lift_mm);
  if (!correction.rms_mm.empty()) {
    report["compensation"] = {{"rms_mm", correction.rms_mm}, {"applied", correction.applied}};
  }
  if (options.fill == "wrap") report["wrap"] = {{"alpha_mm", options.wrap_mm[0]}, {"offset_mm", options.wrap_mm[1]}};
  if (opaque) {
    report["insert"] = slice_tool::insert_figures(volumes.front(), *opaque, *insert, options);
    volumes.push_back(std::move(*opaque));
  }
  write(app, options, printer, volumes);
  io::write_report(options.report, "vam-slice", report);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-slice",
                "voxelise a mesh, images or a test part into the target volume",
                manual_page,
                {},
                false,
                {cli::ManualList{"shapes", solid::describe_shapes()}}});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
