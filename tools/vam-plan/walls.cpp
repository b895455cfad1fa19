// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/log/log.hpp"
#include "solid/voxel/size_doubt.hpp"
#include "solid/voxel/wall.hpp"
#include "vam-plan/plan.hpp"

namespace vam::plan_tool {

namespace {

constexpr double most_voxels = 16e6;  // of the grid on which walls are measured

void warn_of_resolution(const std::string& subject, const Filled& fine, double stretch_z) {
  for (const std::string& doubt :
       solid::resolution_doubts(subject, fine.content.unresolved, fine.volume.grid, stretch_z))
    warn(doubt);
}

/// Which half-covered voxels either leave out or show as thick as a voxel.
bool has_walls_below_a_voxel(const verdict::SubVoxelFeatures& unresolved, const solid::Walls& walls) {
  const bool thin = walls.thinnest_voxels && *walls.thinnest_voxels < model::thin_voxels;
  return unresolved.loses_walls() || (thin && unresolved.is_much());
}

solid::Walls::Place place_of(const model::ThinPlaces& walls, const Plan& plan) {
  const auto& [x, y, z] = walls.at_mm;
  return {walls.mm / plan.grid.voxel_mm, walls.mm, {x, y, z / plan.stretch_z}};
}

/// Where walls are measured on larger voxels, what the part's own surface tells.
verdict::SubVoxelFeatures of_prints_voxels(const Plan& plan, const solid::Part& part, const Filled& fine) {
  if (plan.wall_resolution == 1) return fine.content.unresolved;
  verdict::SubVoxelFeatures told;
  if (part.surface) told.surface = {part.surface(plan.grid), plan.grid.voxel_mm};
  return told;
}

}  // namespace

void add_walls(Plan& plan, const solid::Part& part) {
  const double by = std::ceil(std::cbrt(static_cast<double>(plan.grid.size()) / most_voxels));
  plan.wall_resolution = std::max(1, static_cast<int>(by));
  const Filled fine =
      filled(plan.wall_resolution == 1 ? part : without_surface(part), plan.wall_resolution * plan.grid.voxel_mm);
  plan.unresolved = of_prints_voxels(plan, part, fine);
  if (plan.wall_resolution == 1 && fine.content.solid_voxels > 0)
    warn_of_resolution(part.subject, fine, plan.stretch_z);
  const solid::Walls walls = solid::walls(fine.volume, plan.stretch_z);
  plan.sharp_edges = walls.sharp_edges;
  plan.cavities = fine.content.cavities;
  plan.wall_voxels = walls.thinnest_voxels;
  plan.wall_mm = walls.thinnest_mm;
  if (has_walls_below_a_voxel(fine.content.unresolved, walls)) plan.wall_voxels.reset();
  if (!plan.wall_voxels) return;
  *plan.wall_voxels *= plan.wall_resolution;
  plan.thinnest_place = walls.thinnest_place;
  if (plan.thinnest_place) plan.thinnest_place->voxels *= plan.wall_resolution;
  if (!plan.unresolved.surface) return;
  const model::ThinPlaces& thin = plan.unresolved.surface->places.walls;
  if (!thin.are_below(model::lost_voxels, plan.grid.voxel_mm)) return;
  const solid::Walls::Place place = place_of(thin, plan);
  if (!plan.thinnest_place || place.voxels < plan.thinnest_place->voxels) plan.thinnest_place = place;
}

}  // namespace vam::plan_tool
