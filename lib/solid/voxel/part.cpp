// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/part.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"
#include "solid/mesh/part_surface.hpp"
#include "solid/shapes/shapes.hpp"
#include "solid/voxel/trapped_resin.hpp"

namespace vam::solid {

Part shape_part(const std::string& text, const Placement& placement, const Writable& room) {
  const Field shape = make_shape(text);
  Part part;
  part.subject = "shape " + text;
  part.map = place(shape, placement, room, part.subject);
  const Field placed = transformed(shape, part.map);
  part.extent = extent(placed);
  part.fill = [placed](const model::Grid& grid, const SliceSink& sink) {
    std::vector<float> slices(grid.slice_size() * slab);
    for (int k = 0; k < grid.nz; k += slab) {
      const int count = std::min(slab, grid.nz - k);
      cover(placed, grid, k, count, slices.data());
      sink(k, count, slices.data());
    }
    return Vote{};
  };
  return part;
}

void warn_of_repairs(const Part& part) {
  if (!part.repair || (!part.repair->changed() && part.repair->closed())) return;
  warn(part.subject + ": " + part.repair->summary() +
       (part.repair->closed() ? "" : "; the inside is determined by majority"));
}

Part lifted(Part part, double lift_mm) {
  part.map.shift[2] += lift_mm;
  part.extent.box.low[2] += lift_mm;
  part.extent.box.high[2] += lift_mm;
  part.fill = [lift_mm, fill = std::move(part.fill)](model::Grid grid, const SliceSink& sink) {
    grid.origin_mm[2] -= lift_mm;
    return fill(grid, sink);
  };
  if (!part.surface) return part;
  part.surface = [lift_mm, surface = std::move(part.surface)](model::Grid grid) {
    grid.origin_mm[2] -= lift_mm;
    model::PartSurface places = surface(grid);
    for (auto* kind : {&places.walls, &places.gaps, &places.blocked, &places.relief}) kind->at_mm[2] += lift_mm;
    return places;
  };
  return part;
}

namespace {

/// No larger than some voxels, none of which need be half covered.
bool is_tiny(const PlacedExtent& extent, double voxel_mm) {
  constexpr double some = 4;
  const Point size = extent.box.size();
  return *std::max_element(size.begin(), size.end()) < some * voxel_mm;
}

// A vote that did not settle: nothing enclosed, or too much left open.
void require_settled(const Vote& vote, const Repair& repair, bool tiny, const std::string& subject) {
  if (vote.inside == 0 ? tiny : vote.undecided <= vote.inside / 100) return;
  const std::string found = vote.inside == 0 ? "it encloses no volume"
                                             : std::to_string(vote.undecided) + " of " + std::to_string(vote.inside) +
                                                   " voxels are undecided";
  throw Error{Fault::data, subject + ": the inside cannot be determined: the surface has " +
                               std::to_string(repair.boundary_edges) + " boundary edges and " + found +
                               "; close it in a mesh editor, or slice it with --fill wrap"};
}

}  // namespace

Part mesh_part(model::TriangleSoup mesh, const std::string& subject, const Affine& map, FillMode mode) {
  transform(mesh, map);
  Part part;
  part.subject = subject;
  part.map = map;
  part.repair = repair(mesh, subject);
  if (mode == FillMode::exact && !part.repair->closed()) {
    throw Error{Fault::data, subject + ": is not closed (" + part.repair->summary() +
                                 "); automatic filling determines the inside by majority"};
  }
  part.voted = mode == FillMode::vote || !part.repair->closed();
  part.extent = extent(mesh);
  const auto kept = std::make_shared<model::TriangleSoup>(std::move(mesh));
  part.fill = [kept, subject, repair = *part.repair, voted = part.voted, extent = part.extent](const model::Grid& grid,
                                                                                               const SliceSink& sink) {
    const Vote vote = voxelize(*kept, grid, voted ? Fill::vote : Fill::exact, repair.shared, sink);
    if (voted) require_settled(vote, repair, is_tiny(extent, grid.voxel_mm), subject);
    return vote;
  };
  part.surface = [kept, repair = *part.repair](const model::Grid& grid) { return part_surface(*kept, repair, grid); };
  return part;
}

namespace {

/// What a slice holds, its volume in voxels.
FillSummary summary_of(const model::Grid& grid, const float* row) {
  FillSummary content;
  for (int j = 0; j < grid.ny; ++j, row += grid.nx) {
    int first = grid.nx;
    int last = -1;
    for (int i = 0; i < grid.nx; ++i) {
      const float value = row[i];
      if (value == 0) continue;
      content.volume_mm3 += value;
      content.most = std::max(content.most, value);
      const model::Label label = model::label_of(value);
      if (label == model::Label::void_) continue;
      ++(label == model::Label::part ? content.solid_voxels : content.surface_voxels);
      first = std::min(first, i);
      last = i;
    }
    if (last < 0) continue;
    const double x = std::max(std::abs(grid.x_mm(first)), std::abs(grid.x_mm(last)));
    content.radius_mm = std::max(content.radius_mm, std::hypot(x, grid.y_mm(j)));
  }
  return content;
}

}  // namespace

FillSummary fill(const Part& part, const model::Grid& grid, const SliceSink& sink) {
  FillSummary content;
  verdict::SubVoxelFinder finder(grid);
  verdict::CavityFinder cavities(grid);
  content.vote = part.fill(grid, [&](int k0, int count, const float* slices) {
    std::vector<FillSummary> of_slice(static_cast<std::size_t>(count));
    parallel_for(count, [&](int k) { of_slice[k] = summary_of(grid, slices + product(k, grid.slice_size())); });
    for (const FillSummary& slice : of_slice) {
      content.volume_mm3 += slice.volume_mm3;
      content.most = std::max(content.most, slice.most);
      content.solid_voxels += slice.solid_voxels;
      content.surface_voxels += slice.surface_voxels;
      content.radius_mm = std::max(content.radius_mm, slice.radius_mm);
    }
    finder.add(count, slices);
    cavities.add(count, slices);
    sink(k0, count, slices);
  });
  content.unresolved = finder.found();
  content.cavities = cavities.found();
  if (part.surface) content.unresolved.surface = {part.surface(grid), grid.voxel_mm};
  if (content.volume_mm3 == 0) {
    throw Error{Fault::data, part.subject + ": covers no voxel of " + format_number(grid.voxel_mm) +
                                 " mm; check its unit and the voxel size"};
  }
  content.volume_mm3 *= grid.voxel_mm * grid.voxel_mm * grid.voxel_mm;
  return content;
}

Json figures(const Part& part, const FillSummary& content, const model::Grid& grid, double stretch_z,
             const Writable& room) {
  const Point size = part.extent.box.size();
  Json report{{"volume_mm3", content.volume_mm3 / stretch_z},  // of the print, not of the stretched target
              {"size_mm", {size[0], size[1], size[2] / stretch_z}},
              {"radius_mm", part.extent.radius_mm},
              {"writable_radius_mm", room.radius_mm},
              {"stretch_z", stretch_z},
              {"voxel_mm", grid.voxel_mm},
              {"voxels", {grid.nx, grid.ny, grid.nz}},
              {"interior_voxels", content.solid_voxels},
              {"surface_voxels", content.surface_voxels},
              {"lost_volume_mm3", content.unresolved.lost_walls.voxels * std::pow(grid.voxel_mm, 3) / stretch_z},
              {"lost_gaps_mm3", content.unresolved.lost_gaps.voxels * std::pow(grid.voxel_mm, 3) / stretch_z},
              {"trapped_resin", trapped_resin_figures(content.cavities, grid.voxel_mm, stretch_z)}};
  if (const auto& surface = content.unresolved.surface) {
    const auto places = [&](const model::ThinPlaces& of) -> Json {
      if (of.area_mm2 == 0) return nullptr;
      return {{"area_mm2", of.area_mm2}, {"mm", of.mm}, {"at_mm", {of.at_mm[0], of.at_mm[1], of.at_mm[2] / stretch_z}}};
    };
    report["solids"] = surface->places.solids > 0 ? Json(surface->places.solids) : Json(nullptr);
    report["thin_walls"] = places(surface->places.walls);
    report["thin_gaps"] = places(surface->places.gaps);
    report["blocked_gaps"] = places(surface->places.blocked);
    report["thin_relief"] = places(surface->places.relief);
  }
  if (part.repair) {
    const Repair& done = *part.repair;
    report["repair"] = {{"closed", done.closed()},
                        {"points_welded", done.points_welded},
                        {"weld_distance_mm", done.weld_distance},
                        {"degenerate_dropped", done.degenerate_dropped},
                        {"duplicates_dropped", done.duplicates_dropped},
                        {"triangles_flipped", done.flipped},
                        {"components", done.components},
                        {"cavities", done.cavities},
                        {"boundary_edges", done.boundary_edges},
                        {"non_manifold_edges", done.non_manifold_edges},
                        {"undecided_voxels", content.vote.undecided}};
  }
  return report;
}

}  // namespace vam::solid
