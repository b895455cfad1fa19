// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-plan/plan.hpp"

#include <cmath>
#include <utility>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"
#include "model/grid_size.hpp"
#include "model/magnification.hpp"
#include "optics/writable_radius.hpp"
#include "session/surface.hpp"
#include "solid/voxel/size_doubt.hpp"

namespace vam::plan_tool {

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

namespace {

double voxel_of(const Options& options, const model::Printer& printer) {
  return options.voxel_mm.value_or(printer.projector.pixel_mm);
}

constexpr double bath_of_radius = 1.5;  // the window of a bath that is not there yet, from the axis

solid::Writable room_of(const model::Printer& printer) {
  return solid::writable(printer, optics::writable_radius_mm(printer));
}

/// What is planned, read once: it may be scaled to fit.
class Source {
 public:
  explicit Source(const Options& options)
      : options_(options), subject_(options.shape.empty() ? io::input_name(options.input) : "shape " + options.shape) {
    solid::Placement turned;
    turned.axes = solid::upright(options.up);
    if (options.shape.empty()) mesh_ = session::array_in_unit(options.input, options.array, options.unit_given, turned);
    axes_ = turned.axes;
  }
  [[nodiscard]] const std::string& subject() const { return subject_; }
  [[nodiscard]] solid::Part part(const model::Printer& printer, double factor) const {
    solid::Part made = options_.shape.empty()
                           ? solid::mesh_part(mesh_, subject_, map(printer, factor), solid::FillMode::automatic)
                           : solid::shape_part(options_.shape, placement(printer, factor), room_of(printer));
    made.lattice = solid::row_lattice(printer.projector, voxel_of(options_, printer));
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
    return solid::place(mesh_, placement(printer, factor), room_of(printer), subject_);
  }
  [[nodiscard]] solid::Placement placement(const model::Printer& printer, double factor) const {
    solid::Placement made;
    made.axes = axes_;
    made.scale = options_.scale * solid::mm_per(options_.unit) * factor;
    made.stretch_z = 1 / model::vertical_magnification(printer);
    made.voxel_mm = voxel_of(options_, printer);
    return made;
  }

  const Options& options_;
  std::string subject_;
  model::TriangleSoup mesh_;
  solid::Affine axes_;
};

Fit fit_of(const Source& source, const model::Printer& printer, double voxel_mm) {
  const solid::PlacedExtent extent = source.extent(printer);
  const solid::Writable room = room_of(printer);
  const double stretch = 1 / model::vertical_magnification(printer);
  Fit fit;
  fit.size_mm = extent.box.size();
  fit.size_mm[2] /= stretch;
  fit.writable_radius_mm = room.radius_mm;
  fit.writable_height_mm = (room.high_mm - room.low_mm) / stretch;
  fit.factor = solid::fitting_factor(extent, room, voxel_mm);
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

}  // namespace

Plan plan(const Options& options, const model::Printer& printer) {
  const Source source(options);
  const double voxel = voxel_of(options, printer);
  Plan made;
  made.now = fit_of(source, printer, voxel);
  if (printer.bath.index != printer.resin.index) {
    model::Printer matched = printer;
    matched.bath.index = printer.resin.index;
    if (matched.bath.window_mm == 0) matched.bath.window_mm = bath_of_radius * printer.vial.radius_mm;
    made.bath = fit_of(source, matched, voxel);
  }
  require_plausible(made.now, printer, source.subject());
  warn_of_unit(made.now, options, room_of(printer), source.subject());
  made.given_scale = options.scale;
  made.scale = made.now.fits() ? options.scale : solid::three_digits(options.scale * made.now.factor);
  const solid::Part part = within_rows(source.part(printer, made.scale / options.scale), room_of(printer), voxel);
  solid::warn_of_repairs(part);
  made.subject = part.subject;
  made.grid = solid::grid_around(part.extent, voxel, 0, part.lattice, part.subject);
  made.stretch_z = 1 / model::vertical_magnification(printer);
  add_walls(made, part);
  if (options.no_preview) return made;
  made.estimate = estimated({.part = part,
                             .printer = printer,
                             .grid = made.grid,
                             .unresolved = made.unresolved,
                             .thinnest_voxels = made.thinnest_voxels(),
                             .sharp_edges = made.sharp_edges,
                             .stretch_z = made.stretch_z,
                             .on_these_voxels = options.voxel_mm.has_value()});
  return made;
}

}  // namespace vam::plan_tool
