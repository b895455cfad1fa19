// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/compensation.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "solid/voxel/isosurface.hpp"

namespace vam::solid {

namespace {

double margin_mm(double largest_mm, double voxel_mm) { return std::max(largest_mm / 12, 6 * voxel_mm); }

double band_of(const model::TriangleSoup& design, double voxel_mm) {
  return margin_mm(bounding_box(design).largest_side(), voxel_mm) - voxel_mm;
}

}  // namespace

model::Grid deviation_grid(const model::TriangleSoup& design, double voxel_mm) {
  const Bounds box = bounding_box(design);
  const double pitch = voxel_mm > 0 ? voxel_mm : box.largest_side() / 100;
  const double margin = margin_mm(box.largest_side(), pitch);
  model::Grid grid;
  grid.voxel_mm = pitch;
  int* sizes[] = {&grid.nx, &grid.ny, &grid.nz};
  for (std::size_t a = 0; a < 3; ++a) {
    *sizes[a] = ceil_int((box.high[a] - box.low[a] + 2 * margin) / pitch) + 1;
    grid.origin_mm[a] = 0.5 * (box.low[a] + box.high[a] - (*sizes[a] - 1) * pitch);
  }
  return grid;
}

model::Volume deviation_volume(const model::TriangleSoup& print, const model::TriangleSoup& design,
                               const model::Grid& grid) {
  const double band = band_of(design, grid.voxel_mm);
  model::Volume volume = distance_band(Surface(design), grid, band);
  const model::Volume printed = distance_band(Surface(print), grid, band);
  for (std::size_t i = 0; i < volume.values.size(); ++i) volume.values[i] -= printed.values[i];
  return volume;
}

std::size_t rounds_to_apply(std::span<const double> rms_mm, double uncertainty_mm) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < rms_mm.size(); ++i) {
    if (!(rms_mm[i] < rms_mm[best] - uncertainty_mm)) return rms_mm[i] < rms_mm[best] ? i : best;
    best = i;
  }
  return rms_mm.size();
}

model::TriangleSoup compensated(const model::TriangleSoup& design, std::span<const model::Volume> rounds,
                                double damping) {
  if (rounds.empty()) return design;
  const model::Grid& grid = rounds.front().grid;
  model::Volume inside = distance_band(Surface(design), grid, band_of(design, grid.voxel_mm));
  for (float& value : inside.values) value = -value;
  const auto share = static_cast<float>(damping);
  for (const model::Volume& round : rounds) {
    if (!(round.grid == grid)) {
      throw Error{Fault::data, "compensation: the deviations are of different grids (voxels of " +
                                   format_number(round.grid.voxel_mm) + " and " + format_number(grid.voxel_mm) +
                                   " mm); measure all rounds against the same design with the same voxel"};
    }
    for (std::size_t i = 0; i < inside.values.size(); ++i) inside.values[i] -= share * round.values[i];
  }
  model::TriangleSoup mesh = isosurface(inside, 0);
  if (mesh.triangles.empty()) {
    throw Error{Fault::data, "compensation: nothing of the design remains; are these deviations from this design?"};
  }
  return mesh;
}

}  // namespace vam::solid
