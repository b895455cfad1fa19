// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-plan/plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/stream/input_name.hpp"
#include "mesh_in_unit.hpp"
#include "model/coarser.hpp"
#include "model/dose_metrics.hpp"
#include "model/grid_size.hpp"
#include "model/magnification.hpp"
#include "model/outside.hpp"
#include "optics/writable_radius.hpp"
#include "resin/absolute_dose.hpp"
#include "score/exposure.hpp"
#include "solid/voxel/part.hpp"
#include "solid/voxel/size_doubt.hpp"
#include "solid/voxel/wall.hpp"

namespace vam::plan_tool {

namespace {

constexpr double bath_of_radius = 1.5;  // the window of a bath that is not there yet, from the axis
constexpr double most_voxels = 16e6;    // of the grid on which walls are measured

solid::Writable room_of(const model::Printer& printer) {
  return solid::writable(printer, optics::writable_radius_mm(printer));
}

solid::Placement placement_of(const Options& options, const model::Printer& printer, double factor) {
  solid::Placement placement;
  placement.axes = solid::upright(options.up);
  placement.scale = options.scale * solid::mm_per(options.unit) * factor;
  placement.stretch_z = 1 / model::vertical_magnification(printer);
  placement.voxel_mm = printer.projector.pixel_mm;
  return placement;
}

/// What is planned, read once: it may be scaled to fit.
class Source {
 public:
  explicit Source(const Options& options)
      : options_(options), subject_(options.shape.empty() ? io::input_name(options.input) : "shape " + options.shape) {
    if (options.shape.empty()) mesh_ = tool::mesh_in_unit(options.input, options.unit_given, "--unit", "--scale");
  }
  [[nodiscard]] const std::string& subject() const { return subject_; }
  [[nodiscard]] solid::Part part(const model::Printer& printer, double factor) const {
    solid::Part made =
        options_.shape.empty()
            ? solid::mesh_part(mesh_, subject_, map(printer, factor), solid::FillMode::automatic)
            : solid::shape_part(options_.shape, placement_of(options_, printer, factor), room_of(printer));
    made.lattice = solid::row_lattice(printer.projector, printer.projector.pixel_mm);
    return made;
  }
  /// At the scale of the options.
  [[nodiscard]] solid::PlacedExtent extent(const model::Printer& printer) const {
    if (!options_.shape.empty()) return part(printer, 1).extent;
    model::TriangleSoup placed = mesh_;  // not repaired, which takes longer than all the rest
    solid::transform(placed, map(printer, 1));
    return solid::extent(placed);
  }

 private:
  [[nodiscard]] solid::Affine map(const model::Printer& printer, double factor) const {
    return solid::place(mesh_, placement_of(options_, printer, factor), room_of(printer), subject_);
  }

  const Options& options_;
  std::string subject_;
  model::TriangleSoup mesh_;
};

Fit fit_of(const Source& source, const model::Printer& printer) {
  const solid::PlacedExtent extent = source.extent(printer);
  const solid::Writable room = room_of(printer);
  const double stretch = 1 / model::vertical_magnification(printer);
  Fit fit;
  fit.size_mm = extent.box.size();
  fit.size_mm[2] /= stretch;
  fit.writable_radius_mm = room.radius_mm;
  fit.writable_height_mm = (room.high_mm - room.low_mm) / stretch;
  fit.factor = solid::fitting_factor(extent, room, printer.projector.pixel_mm);
  return fit;
}

std::string size_text(const Fit& fit) {
  return format_number(fit.size_mm[0], 4) + " x " + format_number(fit.size_mm[1], 4) + " x " +
         format_number(fit.size_mm[2], 4) + " mm";
}

void require_plausible(const Fit& fit, const model::Printer& printer, const std::string& subject) {
  constexpr double most_times = 1000;
  constexpr double rounding = 1e-9;
  if (!(fit.factor > rounding)) {
    throw Error{Fault::data, subject + ": no part fits the cylinder that can be written, of " +
                                 format_number(fit.writable_radius_mm, 3) + " mm radius and " +
                                 format_number(fit.writable_height_mm, 3) + " mm height, with pixels of " +
                                 format_number(printer.projector.pixel_mm, 3) + " mm; check the printer's settings"};
  }
  if (fit.factor < 1 / most_times) {
    throw Error{Fault::data, subject + ": is " + size_text(fit) + ", " + format_number(1 / fit.factor, 3) +
                                 " times too large for this printer; check --unit and --scale"};
  }
}

void warn_of_unit(const Fit& fit, const Options& options, const solid::Writable& room, const std::string& subject) {
  if (!options.shape.empty() || options.unit_known) return;
  const std::string doubt =
      solid::unit_doubt(subject, "part", *std::max_element(fit.size_mm.begin(), fit.size_mm.end()), room);
  if (!doubt.empty()) warn(doubt);
}

/// Moved by whole voxels until the rows light it.
solid::Part within_rows(solid::Part part, const solid::Writable& room, double voxel_mm) {
  const auto& box = part.extent.box;
  const double up = std::ceil(std::max(0.0, room.low_mm - box.low[2]) / voxel_mm) * voxel_mm;
  const double down = std::ceil(std::max(0.0, box.high[2] - room.high_mm) / voxel_mm) * voxel_mm;
  return solid::lifted(std::move(part), up - down);
}

struct Filled {
  model::Volume volume;
  solid::FillSummary content;
};

Filled filled(const solid::Part& part, double voxel_mm) {
  Filled made{{solid::grid_around(part.extent, voxel_mm, 0, part.lattice, part.subject), {}}, {}};
  model::Volume& volume = made.volume;
  require_memory(sizeof(float) * static_cast<double>(volume.grid.size()),
                 part.subject + ": " + model::size_text(volume.grid), "plan a smaller part");
  volume.values.resize(volume.grid.size());
  made.content = solid::fill(part, volume.grid, [&](int k0, int count, const float* slices) {
    std::copy_n(slices, static_cast<std::size_t>(count) * volume.grid.slice_size(), volume.slice(k0));
  });
  return made;
}

/// Of walls and gaps that no voxel of the printer resolves.
void warn_of_resolution(const std::string& subject, const Filled& fine, double stretch_z) {
  for (const std::string& doubt :
       solid::resolution_doubts(subject, fine.content.unresolved, fine.volume.grid, stretch_z))
    warn(doubt);
}

/// Which half-covered voxels either leave out or show as thick as a voxel.
bool has_walls_below_a_voxel(const model::Unresolved& unresolved, const solid::Walls& walls) {
  const bool thin = walls.thinnest_voxels && *walls.thinnest_voxels < model::thin_voxels;
  return unresolved.loses_walls() || (thin && unresolved.is_much());
}

bool doubts(const model::Unresolved& unresolved) {
  return unresolved.loses_walls() || unresolved.shuts_gaps() || unresolved.leaves_doubt() ||
         (unresolved.surface && unresolved.surface->may_be_pierced());
}

solid::Walls::Place place_of(const model::ThinPlaces& walls, const Plan& plan) {
  const auto& [x, y, z] = walls.at_mm;
  return {walls.mm / plan.grid.voxel_mm, walls.mm, {x, y, z / plan.stretch_z}};
}

solid::Part without_surface(solid::Part part) {
  part.surface = {};
  return part;
}

/// Where walls are measured on larger voxels, what the part's own surface tells.
model::Unresolved of_printers_voxels(const Plan& plan, const solid::Part& part, const Filled& fine) {
  if (plan.wall_resolution == 1) return fine.content.unresolved;
  model::Unresolved told;
  if (part.surface) told.surface = {part.surface(plan.grid), plan.grid.voxel_mm};
  return told;
}

/// On the printer's voxels, or on larger ones where these are too many.
void add_walls(Plan& plan, const solid::Part& part) {
  const double by = std::ceil(std::cbrt(static_cast<double>(plan.grid.size()) / most_voxels));
  plan.wall_resolution = std::max(1, static_cast<int>(by));
  const Filled fine =
      filled(plan.wall_resolution == 1 ? part : without_surface(part), plan.wall_resolution * plan.grid.voxel_mm);
  const model::Unresolved unresolved = of_printers_voxels(plan, part, fine);
  if (plan.wall_resolution == 1 && fine.content.solid_voxels > 0)
    warn_of_resolution(part.subject, fine, plan.stretch_z);
  const solid::Walls walls = solid::walls(fine.volume, plan.stretch_z);
  plan.sharp_edges = walls.sharp_edges;
  plan.cavities = fine.content.cavities;
  plan.wall_voxels = walls.thinnest_voxels;
  plan.wall_mm = walls.thinnest_mm;
  plan.in_doubt = doubts(unresolved);
  if (has_walls_below_a_voxel(fine.content.unresolved, walls)) plan.wall_voxels.reset();
  if (unresolved.surface) plan.surface = unresolved.surface->places;
  if (!plan.wall_voxels) return;
  *plan.wall_voxels *= plan.wall_resolution;
  plan.thinnest_place = walls.thinnest_place;
  if (plan.thinnest_place) plan.thinnest_place->voxels *= plan.wall_resolution;
  const model::ThinPlaces& thin = plan.surface.walls;
  if (!thin.are_below(model::lost_voxels, plan.grid.voxel_mm)) return;
  const solid::Walls::Place place = place_of(thin, plan);
  if (!plan.thinnest_place || place.voxels < plan.thinnest_place->voxels) plan.thinnest_place = place;
}

double million_voxels(const model::Grid& grid, int coarseness) {
  return 1e-6 * static_cast<double>(grid.size()) / std::pow(coarseness, 3);
}

/// The part on the voxels of an estimate.
struct Coarse {
  model::Printer printer;
  Filled part;

  [[nodiscard]] const model::Unresolved& unresolved() const { return part.content.unresolved; }
  /// Whether some voxel is wholly inside the part.
  [[nodiscard]] bool is_judged() const {
    const std::vector<float>& values = part.volume.values;
    return std::any_of(values.begin(), values.end(),
                       [](float coverage) { return model::label_of(coverage) == model::Label::part; });
  }
  /// Whether walls and gaps are as thick as the voxels, but for edges: hardly any is lost, little is not resolved.
  [[nodiscard]] bool is_all_judged() const {
    constexpr double most_lost = 0.001;
    const double lost = unresolved().lost_walls.voxels + unresolved().lost_gaps.voxels;
    return is_judged() && lost <= most_lost * unresolved().whole && !unresolved().is_much();
  }
};

Coarse coarse(const solid::Part& part, const model::Printer& printer, int coarseness) {
  Coarse made{printer, {}};
  for (int by = 1; by < coarseness; by *= 2) made.printer = model::coarser(made.printer);
  made.part = filled(part, made.printer.projector.pixel_mm);
  return made;
}

optimize::Preview preview_of(Coarse coarse, int coarseness) {
  optimize::PreviewTask task;
  task.printer = std::move(coarse.printer);
  task.part = model::covered_box(coarse.part.volume, model::coverage_rounding);
  task.radius_mm = optics::judged_radius_mm(task.printer, coarse.part.content.radius_mm);
  task.target = std::move(coarse.part.volume);
  task.tolerances = model::parse_tolerances(deviations);
  task.tolerances[static_cast<std::size_t>(model::Deviating::axis)] /= coarseness;  // of the printer's pixels
  return optimize::preview(task);
}

void estimate(Plan& plan, Coarse judged) {
  const model::Grid& grid = judged.part.volume.grid;
  plan.unjudged = judged.unresolved();
  plan.all_judged = judged.is_all_judged();
  plan.unjudged_low_mm = grid.z_mm(judged.unresolved().first - 0.5) / plan.stretch_z;
  plan.unjudged_high_mm = grid.z_mm(judged.unresolved().end - 0.5) / plan.stretch_z;
  if (!judged.is_judged()) return;
  plan.preview = preview_of(std::move(judged), plan.coarseness);
  plan.pieces = plan.preview->outcome.pieces;
  if (plan.pieces) plan.pieces->set_solids(plan.surface);
}

/// On voxels that are larger for large parts, and smaller for those of thin walls or gaps, or that the estimate tears.
void add_preview(Plan& plan, const solid::Part& part, const model::Printer& printer) {
  int& by = plan.coarseness = usual_coarseness;
  while (million_voxels(plan.grid, by) > most_estimated) by *= 2;
  const auto can_be_finer = [&] { return by > 1 && million_voxels(plan.grid, by / 2) <= most_finer; };
  Coarse judged = coarse(part, printer, by);
  while (!judged.is_all_judged() && can_be_finer()) judged = coarse(part, printer, by /= 2);
  estimate(plan, std::move(judged));
  while (plan.pieces && !plan.pieces->is_surely_as_part() && can_be_finer())
    estimate(plan, coarse(part, printer, by /= 2));
}

}  // namespace

Plan plan(const Options& options, const model::Printer& printer) {
  if (!options.shape.empty() && options.input != "-") throw Error{Fault::usage, "PART, --shape: give only one of them"};
  const Source source(options);
  Plan made;
  made.now = fit_of(source, printer);
  if (printer.bath.index != printer.resin.index) {
    model::Printer matched = printer;
    matched.bath.index = printer.resin.index;
    if (matched.bath.window_mm == 0) matched.bath.window_mm = bath_of_radius * printer.vial.radius_mm;
    made.bath = fit_of(source, matched);
  }
  require_plausible(made.now, printer, source.subject());
  warn_of_unit(made.now, options, room_of(printer), source.subject());
  made.given_scale = options.scale;
  made.scale = made.now.fits() ? options.scale : solid::three_digits(options.scale * made.now.factor);
  const solid::Part part =
      within_rows(source.part(printer, made.scale / options.scale), room_of(printer), printer.projector.pixel_mm);
  solid::warn_of_repairs(part);
  made.subject = part.subject;
  made.grid = solid::grid_around(part.extent, printer.projector.pixel_mm, 0, part.lattice, part.subject);
  made.stretch_z = 1 / model::vertical_magnification(printer);
  add_walls(made, part);
  if (options.no_preview) return made;
  add_preview(made, without_surface(part), printer);
  if (!made.preview) return made;
  const optimize::VolumeOutcome& outcome = made.preview->outcome;
  const auto per_radian = resin::dose_per_radian_mj_cm3(printer);
  made.resin_known = per_radian.has_value();
  if (per_radian && outcome.peak_intensity > 0 && score::window_middle(outcome.metrics) > 0) {
    made.exposure = score::plan_exposure(outcome.metrics, *per_radian / outcome.peak_intensity, printer, 1,
                                         optimize::DoseWindow{}.threshold());
  }
  return made;
}

}  // namespace vam::plan_tool
