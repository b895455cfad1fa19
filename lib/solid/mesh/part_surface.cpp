// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/part_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "solid/mesh/private/separate_solids.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::solid {

namespace {

constexpr double most_samples = 200'000;
constexpr double least_samples = 2'000;
constexpr std::size_t most_verified = 10'000;
constexpr double meet_voxels = 6;               // faces that meet nearer make an edge
constexpr double meet_times = 4;                // or of their distance: 14 degrees apart from parallel
constexpr double facing_cosine = -0.5;          // of normals: 60 degrees apart from parallel
constexpr double bluntest_edge_cosine = -0.17;  // of less than 80 degrees
constexpr double least_gap = 0.05;              // voxels: shells that are nearer touch, in any print
constexpr double least_solid = 16;              // voxels: smaller ones may not count in a print
constexpr double least_area = 2;                // faces of a voxel: less is a tip
constexpr double own_face = 1e-6;               // of the reach: nearer is the face that the ray leaves from

/// The way from a face straight to the one on the other side.
struct Crossing {
  Vector3 from, along;
  double distance;
  double cosine;  // of both faces' normals
  bool apart;     // they are of surfaces that do not touch
  [[nodiscard]] Vector3 at(double way) const { return from + way * along; }
  [[nodiscard]] bool is_edge() const { return cosine <= bluntest_edge_cosine; }
  /// How far off the faces meet, straight on.
  [[nodiscard]] double meets() const {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return sine > 0 ? -cosine * distance / sine : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] bool is_between_faces(double voxel_mm) const {
    return cosine <= facing_cosine && (apart || meets() >= std::max(meet_voxels * voxel_mm, meet_times * distance));
  }
};

using Ways = std::vector<std::optional<Crossing>>;

/// Points of a surface, the ways from them to both sides, and the area that each stands for.
struct Crossings {
  std::vector<SurfaceSample> samples;
  Ways inwards, outwards;  // of each sample
  double each = 0;
};

/// To one side, at least and at most so far.
void look_across(const SurfaceTree& surface, const SeparateSolids& solids, const std::vector<SurfaceSample>& samples,
                 double side, double least, double most, Ways& found) {
  found.resize(samples.size());
  for_chunks(samples.size(), [&](std::size_t i, int) {
    const SurfaceSample& sample = samples[i];
    const Vector3 along = side * sample.normal;
    const auto hit = surface.tree->first_hit(sample.point, along, least, most);
    if (!hit) return;
    const Vector3 normal = twice_area(surface.tree->triangles[hit->triangle]);
    found[i] =
        Crossing{sample.point, along, hit->distance, dot(normal, sample.normal) / length(normal),
                 !solids.are_one(surface.point_of(sample.triangle), surface.point_of(surface.place(hit->triangle)))};
  });
}

/// Only those between void and solid, as surfaces may lie within others or cross themselves; of so many samples that it
/// is quick.
void leave_outer(Crossings& all, const SurfaceTree& surface, double voxel_mm) {
  const auto is_there = [](const auto& crossing) { return crossing.has_value(); };
  const auto count = std::count_if(all.inwards.begin(), all.inwards.end(), is_there) +
                     std::count_if(all.outwards.begin(), all.outwards.end(), is_there);
  if (count == 0) return;
  const std::size_t step = static_cast<std::size_t>(count) / most_verified + 1;
  Crossings some{{}, {}, {}, all.each * static_cast<double>(step)};
  for (std::size_t i = 0; i < all.samples.size(); i += step) {
    some.samples.push_back(all.samples[i]);
    some.inwards.push_back(all.inwards[i]);
    some.outwards.push_back(all.outwards[i]);
  }
  const WindingNumber& winding = surface.winding();
  const double beside = 0.02 * voxel_mm;
  const auto divides = [&](const Crossing& across, bool solid) {
    const auto inside = [&](double way) { return winding(across.at(way)) > 0.5; };
    return inside(0.5 * across.distance) == solid && inside(-beside) != solid &&
           inside(across.distance + beside) != solid;
  };
  parallel_for(count_of(some.samples), [&](int i) {
    if (some.inwards[i] && !divides(*some.inwards[i], true)) some.inwards[i].reset();
    if (some.outwards[i] && !divides(*some.outwards[i], false)) some.outwards[i].reset();
  });
  all = std::move(some);
}

using Place = std::array<int, 3>;

/// Of cubes of that side, the one that holds the point.
Place block_of(const Vector3& point, double side) {
  return {floor_int(point[0] / side), floor_int(point[1] / side), floor_int(point[2] / side)};
}

/// The n-th of a place and its 26 neighbours.
Place beside(const Place& place, int n) {
  return {place[0] + n % 3 - 1, place[1] + n / 3 % 3 - 1, place[2] + n / 9 - 1};
}

/// Whether the voxel of the grid that holds a point, or one of its 26 neighbours, is wholly outside the part; the grid
/// goes on beyond its ends.
bool has_void_near(const SurfaceTree& surface, const model::Grid& grid, const Vector3& point) {
  constexpr double touched = 0.499;  // half of a side: what cuts off less is rounding
  for (int n = 0; n < 27; ++n) {
    const Place step = beside({}, n);
    Vector3 centre{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double at = std::round((point[d] - grid.origin_mm[d]) / grid.voxel_mm) + step[d];
      centre[d] = grid.origin_mm[d] + at * grid.voxel_mm;
    }
    if (!surface.tree->meets_cube(centre, touched * grid.voxel_mm) && surface.winding()(centre) < 0.5) return true;
  }
  return false;
}

/// Of the gaps those that no voxel resolves.
Ways blocked(const Ways& gaps, const SurfaceTree& surface, const model::Grid& grid) {
  Ways found(gaps.size());
  parallel_for(count_of(gaps), [&](int i) {
    const auto& gap = gaps[i];
    if (!gap || !gap->is_between_faces(grid.voxel_mm)) return;
    if (!has_void_near(surface, grid, gap->at(0.5 * gap->distance))) found[i] = gap;
  });
  return found;
}

/// The n-th shortest way, and the area of all.
model::ThinPlaces summary(std::vector<Crossing> crossings, std::size_t n, double area_mm2) {
  if (crossings.size() <= n) return {};
  const auto at = crossings.begin() + static_cast<std::ptrdiff_t>(n);
  std::nth_element(crossings.begin(), at, crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.distance < b.distance; });
  return {area_mm2, at->distance, at->at(0.5 * at->distance)};
}

/// Of a cube of three voxels or more, in which a plane has a dozen samples.
double side_of_block(double each, double voxel_mm) { return std::max(3 * voxel_mm, std::sqrt(12 * each)); }

/// Without those between faces that are a small share of the surface around them, as the small facets along an edge and
/// the run-out of a thread are.
Ways without_lone(Ways ways, const Crossings& all, double voxel_mm) {
  constexpr int share = 4;
  struct Block {
    int samples = 0, ways = 0;
  };
  const double side = side_of_block(all.each, voxel_mm) / 3;
  std::map<Place, Block> blocks;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    Block& block = blocks[block_of(all.samples[i].point, side)];
    ++block.samples;
    block.ways += ways[i] && ways[i]->is_between_faces(voxel_mm) ? 1 : 0;
  }
  const auto around = [&](const Place& place) {  // in 27 blocks
    Block sum;
    for (int n = 0; n < 27; ++n) {
      const auto block = blocks.find(beside(place, n));
      if (block == blocks.end()) continue;
      sum.samples += block->second.samples;
      sum.ways += block->second.ways;
    }
    return sum;
  };
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!ways[i]) continue;
    const Block block = around(block_of(all.samples[i].point, side));
    if (share * block.ways < block.samples) ways[i].reset();
  }
  return ways;
}

/// Of those that are at most so long.
model::ThinPlaces between_faces(const Ways& crossings, double most, double each, double voxel_mm) {
  std::vector<Crossing> found;
  for (const auto& one : crossings)
    if (one && one->distance <= most && one->is_between_faces(voxel_mm)) found.push_back(*one);
  const double enough = std::max(2.0, least_area * voxel_mm * voxel_mm / each);
  const double area_mm2 = each * static_cast<double>(found.size());
  return summary(std::move(found), static_cast<std::size_t>(enough) - 1, area_mm2);
}

/// Of blocks in which ridges and grooves are a tenth of the surface each.
model::ThinPlaces relief(const Crossings& all, double voxel_mm) {
  struct Block {
    int samples = 0, ridges = 0, grooves = 0;
    std::vector<Crossing> edges;
    [[nodiscard]] bool has_relief() const { return 10 * ridges >= samples && 10 * grooves >= samples; }
  };
  constexpr double much = 120;  // faces of a voxel: less lies along an edge, as at the foot of an oblique wall
  const double side = side_of_block(all.each, voxel_mm);
  std::map<Place, Block> blocks;
  for (std::size_t i = 0; i < all.samples.size(); ++i) {
    Block& block = blocks[block_of(all.samples[i].point, side)];
    ++block.samples;
    for (const auto& [crossing, count] :
         {std::pair{&all.inwards[i], &block.ridges}, std::pair{&all.outwards[i], &block.grooves}}) {
      if (!*crossing || !(*crossing)->is_edge() || (*crossing)->distance > model::thin_voxels * voxel_mm) continue;
      ++*count;
      block.edges.push_back(**crossing);
    }
  }
  int found = 0;
  std::vector<Crossing> edges;
  for (const auto& [at, block] : blocks) {
    if (!block.has_relief()) continue;
    found += block.samples;
    edges.insert(edges.end(), block.edges.begin(), block.edges.end());
  }
  const double area_mm2 = found * all.each;
  if (area_mm2 < much * voxel_mm * voxel_mm) return {};
  const std::size_t median = edges.size() / 2;
  return summary(std::move(edges), median, area_mm2);
}

}  // namespace

model::PartSurface part_surface(const model::TriangleSoup& mesh, const Repair& repaired, const model::Grid& grid) {
  const SurfaceTree surface(mesh);
  if (surface.tree->triangles.empty()) return {};
  const double voxel_mm = grid.voxel_mm;
  const double face = voxel_mm * voxel_mm;
  const double area = area_of(mesh);
  Crossings all;
  all.samples = sample_surface(mesh, static_cast<int>(std::clamp(area / face, least_samples, most_samples)));
  all.each = area / static_cast<double>(all.samples.size());
  const double touching = least_gap * voxel_mm;
  const SeparateSolids solids =
      separate_solids(surface, repaired, all.samples, touching, least_solid * face * voxel_mm);
  const double lost = model::lost_voxels * voxel_mm;
  const double reach = model::free_voxels * voxel_mm;
  look_across(surface, solids, all.samples, -1, own_face * lost, lost, all.inwards);
  look_across(surface, solids, all.samples, 1, touching, reach, all.outwards);
  leave_outer(all, surface, voxel_mm);
  const Ways gaps = without_lone(all.outwards, all, voxel_mm);
  model::PartSurface found;
  found.walls = between_faces(without_lone(all.inwards, all, voxel_mm), lost, all.each, voxel_mm);
  found.gaps = between_faces(gaps, lost, all.each, voxel_mm);
  found.blocked = between_faces(blocked(gaps, surface, grid), reach, all.each, voxel_mm);
  found.relief = relief(all, voxel_mm);
  found.solids = solids.count;
  found.specks = solids.specks;
  return found;
}

}  // namespace vam::solid
