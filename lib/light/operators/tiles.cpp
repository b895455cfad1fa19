// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/tiles.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::light {

namespace {

/// Voxels [first.i, end.i) x [first.j, end.j), and those that follow them by quarters of a turn.
struct Area {
  VoxelColumn first, end;
  int quarters = 1;
};

/// What the tiles fill: a quarter of the slice where the others follow, with the middle voxel where there is one.
std::vector<Area> areas(const model::Grid& grid, int quarters) {
  if (quarters == 1) return {{{0, 0}, {grid.nx, grid.ny}}};
  const int half = grid.nx / 2;
  if (grid.nx % 2 == 0) return {{{half, half}, {grid.nx, grid.nx}, quarters}};
  return {{{half + 1, half}, {grid.nx, grid.nx}, quarters}, {{half, half}, {half + 1, half + 1}}};
}

std::vector<Area> cut(const Area& area) {
  std::vector<Area> tiles;
  for (int j = area.first.j; j < area.end.j; j += Tile::edge) {
    for (int i = area.first.i; i < area.end.i; i += Tile::edge) {
      tiles.push_back(
          {{i, j}, {std::min(i + Tile::edge, area.end.i), std::min(j + Tile::edge, area.end.j)}, area.quarters});
    }
  }
  return tiles;
}

Tile tile_of(const VialRays& rays, const Area& area) {
  const VialSetup& setup = rays.setup();
  Tile tile;
  tile.quarters = area.quarters;
  RaySource found[VialRays::most_rays];
  double r_mm = 0;
  for (int j = area.first.j; j < area.end.j; ++j) {
    for (int i = area.first.i; i < area.end.i; ++i) {
      const double here_mm = std::hypot(setup.grid.x_mm(i), setup.grid.y_mm(j));
      r_mm = std::max(r_mm, here_mm);
      const int count = rays.posed() ? 0 : rays.find(i, j, found);
      if (count == 0 && !(rays.posed() && here_mm <= setup.radius_mm)) continue;
      for (int k = 0; k < count; ++k) {
        tile.voxel_rays.push_back({count_of(tile.rays), count_of(tile.voxels)});
        tile.rays.push_back(found[k]);
      }
      tile.voxels.push_back({i, j});
    }
  }
  tile.chunk = rays.chunk(r_mm);
  while (tile.rays.size() % ray_block != 0) tile.rays.push_back(tile.rays.back());
  return tile;
}

}  // namespace

VoxelColumn VoxelColumn::turned(int quarters, int size) const {
  VoxelColumn at = *this;
  for (int q = 0; q < quarters; ++q) at = {size - 1 - at.j, at.i};
  return at;
}

std::vector<Tile> tiles(const VialRays& rays) {
  std::vector<Area> cuts;
  for (const Area& area : areas(rays.setup().grid, rays.quarters())) {
    const std::vector<Area> more = cut(area);
    cuts.insert(cuts.end(), more.begin(), more.end());
  }
  std::vector<Tile> all(cuts.size());
  parallel_for(count_of(all), [&](int t) { all[t] = tile_of(rays, cuts[t]); });
  std::erase_if(all, [](const Tile& tile) { return tile.voxels.empty(); });
  return all;
}

}  // namespace vam::light
