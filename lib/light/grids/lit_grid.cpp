// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/lit_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.hpp"
#include "model/magnification.hpp"
#include "model/rows.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

namespace {

/// How much higher a low ray runs at one side of the circle than at the other.
double climb_ratio(const model::Printer& printer, double radius_mm) {
  constexpr double low_mm = 1e-3;
  const optics::SkewRay ray = optics::skew_ray(optics::projector_view(printer), 0, low_mm);
  const double near = ray.z_mm(-radius_mm);
  const double far = ray.z_mm(radius_mm);
  return std::max(near, far) / std::min(near, far);
}

}  // namespace

Margin lit_margin(const model::Printer& printer, const model::Grid& grid, double radius_mm, const model::Poses& poses) {
  Margin margin;
  const double rim =
      0.5 * grid.voxel_mm + std::min({-grid.x_mm(0), -grid.y_mm(0), grid.x_mm(grid.nx - 1), grid.y_mm(grid.ny - 1)});
  const auto voxels = [&](double mm) { return std::max(0, ceil_int(mm / grid.voxel_mm - 1e-6)); };
  margin.side = voxels(radius_mm - rim);
  const double ratio = climb_ratio(printer, radius_mm);
  const model::LiftRange lift = model::lift_mm(poses);
  const double scale = model::vertical_magnification(printer);
  if (lift.least != 0 || lift.most != 0) margin.above = margin.below = 1;
  if (ratio == 1) return margin;
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
  margin.above = voxels(most(grid.z_mm(grid.nz - 1), 1)) + 1;
  margin.below = voxels(most(grid.z_mm(0), -1)) + 1;
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
