// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/fbp.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"

namespace vam::tomo {

namespace {

using std::numbers::pi;

void scale(Slab& slab, float factor) {
  const std::size_t row = product(slab.width, lanes);
  parallel_for(slab.height, [&](int y) {
    float* values = slab.at(0, y);
    for (std::size_t i = 0; i < row; ++i) values[i] *= factor;
  });
}

void check_turn(const ParallelGeometry& geometry) {
  const double turn = std::abs(geometry.angles * geometry.angle_step_rad);
  const bool full = std::abs(turn - 2 * pi) < 1e-6;
  const bool half = std::abs(turn - pi) < 1e-6;
  if (full || (half && geometry.alpha_per_px == 0)) return;
  throw Error{Fault::usage, "filtered back-projection over " + format_number(turn * 180 / pi) +
                                " degrees: it needs 360, or 180 without attenuation"};
}

}  // namespace

ParallelGeometry full_turn(const model::Grid& grid, int angles, int columns, double attenuation_per_mm) {
  if (angles < 1) throw Error{Fault::usage, "number of angles " + std::to_string(angles) + " must be at least 1"};
  if (columns < 0) throw Error{Fault::usage, "number of columns " + std::to_string(columns) + " must be at least 1"};
  ParallelGeometry geometry;
  geometry.nx = grid.nx;
  geometry.ny = grid.ny;
  geometry.angles = angles;
  geometry.axis_x = -grid.origin_mm[0] / grid.voxel_mm;
  geometry.axis_y = -grid.origin_mm[1] / grid.voxel_mm;
  geometry.angle_step_rad = 2 * pi / angles;
  geometry.alpha_per_px = attenuation_per_mm * grid.voxel_mm;
  geometry.columns = columns;
  if (columns == 0) {
    const double x = std::max(geometry.axis_x + 0.5, grid.nx - 0.5 - geometry.axis_x);
    const double y = std::max(geometry.axis_y + 0.5, grid.ny - 0.5 - geometry.axis_y);
    geometry.columns = ceil_int(2 * std::hypot(x, y) - 1e-6);
    if ((geometry.columns - grid.nx) % 2 != 0) ++geometry.columns;
  }
  return geometry;
}

int columns_across(const model::Circle& circle, int nx) {
  const int least = 2 * ceil_int(circle.radius + 0.5) + 1;
  return least + (least + nx) % 2;
}

void fbp(const ParallelGeometry& geometry, std::span<Slab> sinograms, std::span<Slab> images, FilterSpec spec) {
  check_turn(geometry);
  spec.alpha_per_px = geometry.alpha_per_px;
  const Filter filter(geometry.columns, spec);
  for (Slab& sinogram : sinograms) filter.apply(sinogram);
  adjoint(geometry.with_alpha(-geometry.alpha_per_px), sinograms, images);
  for (Slab& image : images) scale(image, static_cast<float>(pi / geometry.angles));
}

Slab fbp(const ParallelGeometry& geometry, Slab sinogram, const FilterSpec& spec) {
  Slab image(geometry.nx, geometry.ny);
  fbp(geometry, std::span(&sinogram, 1), std::span(&image, 1), spec);
  return image;
}

}  // namespace vam::tomo
