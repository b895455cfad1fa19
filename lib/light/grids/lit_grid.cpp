// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/lit_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.hpp"
#include "base/index.hpp"
#include "model/circle.hpp"
#include "model/magnification.hpp"
#include "model/rows.hpp"
#include "optics/chief_ray.hpp"
#include "optics/skew_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::light {

namespace {

int voxels(double some) { return std::max(0, ceil_int(some - 1e-6)); }

/// How much higher a low ray runs at one side of the circle than at the other.
double climb_ratio(const model::Printer& printer, double radius_mm) {
  constexpr double low_mm = 1e-3;
  const optics::SkewRay ray = optics::skew_ray(optics::projector_view(printer), 0, low_mm);
  const double near = ray.z_mm(-radius_mm);
  const double far = ray.z_mm(radius_mm);
  return std::max(near, far) / std::min(near, far);
}

/// How far the light of a point spreads along z within the circle.
double spread_mm(const model::Printer& printer, double radius_mm) {
  const double half_angle_rad = printer.projector.half_angle_deg.value_or(0) * rad_per_deg;
  if (half_angle_rad == 0) return 0;
  const optics::View view = optics::projector_view(printer);
  const double edge_mm = std::min(radius_mm, 0.99 * optics::reach_mm(view));
  double most = 0;
  for (const double t_mm : {0.0, 0.5 * edge_mm, edge_mm}) {
    const double x_p_mm = optics::column_of(view, t_mm).value().x_p_mm;
    const optics::Bundle rays = optics::bundle(view, x_p_mm, printer.projector.focus_mm.value_or(0));
    const double u_mm = model::half_chord(radius_mm, t_mm);
    for (const double u : {-u_mm, u_mm}) most = std::max(most, std::abs(rays.height_rate_mm + u * rays.climb_rate));
  }
  return half_angle_rad * most;
}

}  // namespace

Margin round_margin(const model::Grid& grid, double radius_mm) {
  const double rim =
      0.5 * grid.voxel_mm + std::min({-grid.x_mm(0), -grid.y_mm(0), grid.x_mm(grid.nx - 1), grid.y_mm(grid.ny - 1)});
  return {voxels((radius_mm - rim) / grid.voxel_mm), 0, 0};
}

Margin lit_margin(const model::Printer& printer, const model::Grid& grid, double radius_mm, const model::Poses& poses) {
  Margin margin = round_margin(grid, radius_mm);
  const double ratio = climb_ratio(printer, radius_mm);
  const model::LiftRange lift = model::lift_mm(poses);
  const double scale = model::vertical_magnification(printer);
  if (lift.least != 0 || lift.most != 0) margin.above = margin.below = 1;
  const double width_mm = spread_mm(printer, radius_mm) / scale;
  if (ratio == 1 && width_mm == 0) return margin;
  const model::Projector& p = printer.projector;
  const double lowest_mm = model::z_mm(p, p.rows - 1);
  const double highest_mm = model::z_mm(p, 0);
  const auto spread = [&](double z_mm) { return z_mm > 0 ? z_mm * (ratio - 1) : z_mm * (1 / ratio - 1); };
  // Of an end of the part, `sign` up or down, wherever it passes the image.
  const auto most = [&](double end_mm, double sign) {
    if (poses.empty()) return spread(sign * end_mm);
    const auto in_image = [&](double lift_mm) { return std::clamp(end_mm + lift_mm / scale, lowest_mm, highest_mm); };
    return std::max(spread(sign * in_image(lift.least)), spread(sign * in_image(lift.most)));
  };
  margin.above = voxels((most(grid.z_mm(grid.nz - 1), 1) + width_mm) / grid.voxel_mm) + 1;
  margin.below = voxels((most(grid.z_mm(0), -1) + width_mm) / grid.voxel_mm) + 1;
  return margin;
}

model::Grid extended(const model::Grid& grid, const Margin& margin) {
  model::Grid all = grid;
  all.nx += 2 * margin.side;
  all.ny += 2 * margin.side;
  all.nz += margin.below + margin.above;
  all.origin_mm[0] -= margin.side * grid.voxel_mm;
  all.origin_mm[1] -= margin.side * grid.voxel_mm;
  all.origin_mm[2] -= margin.below * grid.voxel_mm;
  return all;
}

model::VoxelBox moved(model::VoxelBox box, const Margin& margin) {
  const std::array<int, 3> by{margin.side, margin.side, margin.below};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] += by[axis];
    box.high[axis] += by[axis];
  }
  return box;
}

void place_slice(const float* slice, const model::Grid& grid, const Margin& margin, float* to) {
  const int width = grid.nx + 2 * margin.side;
  for (int j = 0; j < grid.ny; ++j) {
    std::copy_n(slice + product(j, grid.nx), grid.nx, to + product(j + margin.side, width) + margin.side);
  }
}

}  // namespace vam::light
