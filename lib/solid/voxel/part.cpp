#include "solid/voxel/part.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "model/dose_metrics.hpp"
#include "solid/shapes/shapes.hpp"

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

Part lifted(Part part, double lift_mm) {
  part.map.shift[2] += lift_mm;
  part.extent.box.low[2] += lift_mm;
  part.extent.box.high[2] += lift_mm;
  part.fill = [lift_mm, fill = std::move(part.fill)](model::Grid grid, const SliceSink& sink) {
    grid.origin_mm[2] -= lift_mm;
    return fill(grid, sink);
  };
  return part;
}

namespace {

// A vote that did not settle: nothing enclosed, or too much left open.
void require_settled(const Vote& vote, const Repair& repair, const std::string& subject) {
  if (vote.inside > 0 && vote.undecided <= vote.inside / 100) return;
  const std::string found = vote.inside == 0 ? "it encloses no volume"
                                             : std::to_string(vote.undecided) + " of " + std::to_string(vote.inside) +
                                                   " voxels are undecided";
  throw Error{Fault::data, subject + ": the inside cannot be determined: the surface has " +
                               std::to_string(repair.boundary_edges) + " boundary edges and " + found +
                               "; close it in a mesh editor"};
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
  part.fill = [kept, subject, repair = *part.repair, voted = part.voted](const model::Grid& grid,
                                                                         const SliceSink& sink) {
    const Vote vote = voxelize(*kept, grid, voted ? Fill::vote : Fill::exact, sink);
    if (voted) require_settled(vote, repair, subject);
    return vote;
  };
  return part;
}

namespace {

/// Distance from the axis to the farthest voxel centre with coverage in these slices.
double farthest_mm(const model::Grid& grid, int count, const float* slices) {
  double farthest = 0;
  for (int line = 0; line < count * grid.ny; ++line) {
    const double y = grid.y_mm(line % grid.ny);
    for (int i = 0; i < grid.nx; ++i) {
      if (*slices++ > model::coverage_rounding) farthest = std::max(farthest, std::hypot(grid.x_mm(i), y));
    }
  }
  return farthest;
}

}  // namespace

FillSummary fill(const Part& part, const model::Grid& grid, const SliceSink& sink) {
  FillSummary content;
  double voxels = 0;
  content.vote = part.fill(grid, [&](int k0, int count, const float* slices) {
    const std::size_t size = grid.slice_size() * static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < size; ++i) {
      voxels += slices[i];
      content.most = std::max(content.most, slices[i]);
      if (slices[i] == 1) {
        ++content.solid_voxels;
      } else if (slices[i] > 0) {
        ++content.surface_voxels;
      }
    }
    content.radius_mm = std::max(content.radius_mm, farthest_mm(grid, count, slices));
    sink(k0, count, slices);
  });
  if (voxels == 0) {
    throw Error{Fault::data, part.subject + ": covers no voxel of " + format_number(grid.voxel_mm) +
                                 " mm; check its unit and the voxel size"};
  }
  content.volume_mm3 = voxels * grid.voxel_mm * grid.voxel_mm * grid.voxel_mm;
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
              {"surface_voxels", content.surface_voxels}};
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
