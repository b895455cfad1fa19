// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/vial_setup.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "model/light_width.hpp"
#include "model/magnification.hpp"
#include "model/rows.hpp"

namespace vam::light {

namespace {

/// What optimisation and simulation of a printer have in common.
VialSetup on_the_bench(const model::Printer& printer, const optics::AxisAlignment& alignment, const model::Grid& grid) {
  VialSetup setup;
  setup.view = optics::projector_view(printer);
  setup.projector = optics::projector_detector(printer, alignment);
  setup.direction = alignment.reverse ? -printer.stage.direction : printer.stage.direction;
  setup.angle_offset_rad = alignment.angle_offset_rad;
  setup.absorption_per_mm = printer.resin.absorption_per_mm;
  setup.grid = grid;
  setup.z_scale = model::vertical_magnification(printer);
  setup.half_angle_rad = setup.rows_half_angle_rad = printer.projector.half_angle_deg.value_or(0) * rad_per_deg;
  setup.focus_mm = printer.projector.focus_mm.value_or(0);
  return setup;
}

void require_columns_of(const optics::Detector& projector, const model::StackInfo& info) {
  if (info.width == projector.columns && std::abs(info.pixel_mm / projector.pixel_mm - 1) < 1e-3) return;
  throw Error{Fault::data, "sinogram: it has " + std::to_string(info.width) + " columns of " + mm_text(info.pixel_mm) +
                               ", the projector " + std::to_string(projector.columns) + " of " +
                               mm_text(projector.pixel_mm) + "; use the printer it was resampled for"};
}

void require_slices_of(const model::Grid& grid, const model::StackInfo& info) {
  if (!(info.row_mm > 0) || std::abs(info.row_mm / grid.voxel_mm - 1) < 1e-3) return;
  throw Error{Fault::data, "sinogram: its slices are " + mm_text(info.row_mm) + " apart, the voxels " +
                               mm_text(grid.voxel_mm) +
                               ": they are not slices of the volume; make both from the same target"};
}

}  // namespace

double hold_rad(const model::Printer& printer, double step_rad) {
  return model::light_width(printer, step_rad * deg_per_rad).hold_deg * rad_per_deg;
}

VialSetup vial_setup(const model::Printer& printer, const model::Grid& grid, int angles, double radius_mm) {
  VialSetup setup = on_the_bench(printer, {}, grid);
  setup.turn = {angles, 0, 2 * std::numbers::pi / angles};
  setup.hold_rad = hold_rad(printer, setup.turn.step_rad);
  setup.radius_mm = radius_mm;
  const model::Projector& p = printer.projector;
  setup.lowest_mm = model::z_mm(p, p.rows - 1);
  setup.highest_mm = model::z_mm(p, 0);
  return setup;
}

void place_rows(VialSetup& setup, const model::Poses& poses, const model::Grid& slices) {
  if (poses.empty()) return;
  constexpr double rounding = 0.01;  // of a row
  const model::LiftRange lift = model::lift_mm(poses);
  const double voxel = setup.grid.voxel_mm;
  const double low_mm = std::max(setup.lowest_mm, slices.z_mm(0) + lift.least / setup.z_scale);
  const double high_mm = std::min(setup.highest_mm, slices.z_mm(slices.nz - 1) + lift.most / setup.z_scale);
  const double first = std::ceil((low_mm - setup.grid.z_mm(0)) / voxel - rounding);
  const double last = std::floor((high_mm - setup.grid.z_mm(0)) / voxel + rounding);
  if (last < first) {
    throw Error{Fault::data, "poses: the slices are at z = " + mm_text(slices.z_mm(0) + lift.least / setup.z_scale) +
                                 " ... " + mm_text(slices.z_mm(slices.nz - 1) + lift.most / setup.z_scale) +
                                 ", but the projector's rows cover " + mm_text(setup.lowest_mm) + " ... " +
                                 mm_text(setup.highest_mm) + "; check projector.axis_row and the poses"};
  }
  setup.poses = poses;
  setup.turn.rows = count_of(poses);
  setup.rows = static_cast<int>(last - first) + 1;
  setup.first_row_mm = setup.grid.z_mm(first);
}

void displace(VialSetup& setup, double vial_x_mm, double vial_y_mm, double sinking_mm) {
  if (vial_x_mm == 0 && vial_y_mm == 0 && sinking_mm == 0) return;
  const int frames = setup.turn.rows;
  if (setup.poses.empty()) setup.poses.resize(static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) {
    const double stage = setup.turn.start_rad + k * setup.turn.step_rad;
    const double c = std::cos(setup.direction * stage), s = std::sin(setup.direction * stage);
    model::Pose& pose = setup.poses[static_cast<std::size_t>(k)];
    pose.angle_deg = stage * deg_per_rad;
    pose.dx_mm += c * vial_x_mm + s * vial_y_mm;
    pose.dy_mm += c * vial_y_mm - s * vial_x_mm;
    pose.dz_mm -= sinking_mm * (k + 0.5) / frames;
  }
}

VialSetup vial_setup(const model::Printer& printer, const optics::AxisAlignment& alignment,
                     const model::StackInfo& info, const model::Grid& grid) {
  VialSetup setup = on_the_bench(printer, alignment, grid);
  require_columns_of(setup.projector, info);
  require_slices_of(grid, info);
  setup.turn = optics::turn_of(info);
  setup.hold_rad = hold_rad(printer, setup.turn.step_rad);
  setup.poses = info.poses;
  setup.rows = info.count;
  setup.first_row_mm = info.z_start_mm;
  return setup;
}

VialSetup completed(VialSetup setup) {
  if (setup.poses.empty()) {
    require_one_turn(setup.turn.rows, setup.turn.step_rad * deg_per_rad);
  } else if (setup.poses.size() != static_cast<std::size_t>(setup.turn.rows)) {
    throw Error{Fault::data, "poses: " + std::to_string(setup.poses.size()) + " poses for " +
                                 std::to_string(setup.turn.rows) + " frames; one pose per frame is required"};
  }
  constexpr double level_mm = 1e9;  // so far away is the lens of rays that stay level and spread
  if (setup.rows_half_angle_rad > 0 && !setup.view.rows_lens_mm) setup.view.rows_lens_mm = level_mm;
  const double resin_mm = optics::resin_radius_mm(setup.view);
  setup.radius_mm = setup.radius_mm > 0 ? std::min(setup.radius_mm, resin_mm) : resin_mm;
  if (setup.rows == 0) {
    setup.rows = setup.grid.nz;
    setup.first_row_mm = setup.grid.z_mm(0);
  }
  return setup;
}

void require_one_turn(int angles, double step_deg) {
  const double covered_deg = angles * std::abs(step_deg);
  if (angles > 0 && std::abs(covered_deg - 360) < 0.01 * std::abs(step_deg)) return;
  throw Error{Fault::data, "sinogram: its " + std::to_string(angles) + " angles cover " + format_number(covered_deg) +
                               " deg; the dose needs exactly one turn"};
}

}  // namespace vam::light
