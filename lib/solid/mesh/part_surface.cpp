// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/part_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "solid/mesh/private/separate_solids.hpp"
#include "solid/mesh/private/winding.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::solid {

namespace {

constexpr double most_samples = 200'000;
constexpr double least_samples = 2'000;
constexpr std::size_t most_verified = 10'000;
constexpr double widest_cosine = -0.88;    // of two faces' normals: 28 degrees apart from parallel
constexpr double sharpest_cosine = -0.17;  // edges of less than 80 degrees
constexpr double least_gap = 1 / 64.0;     // voxels: shells that are nearer touch
constexpr double least_solid = 16;         // voxels: smaller ones may not count in a print
constexpr double own = 1e-6;               // of the reach: nearer is the face that the ray leaves from

/// The way from a face straight to the one on the other side.
struct Crossing {
  Vector3 from, along;
  double distance;
  double cosine;  // of both faces' normals
  [[nodiscard]] bool is_parallel() const { return cosine <= widest_cosine; }
  [[nodiscard]] bool is_edge() const { return cosine <= sharpest_cosine; }
  [[nodiscard]] Vector3 at(double way) const { return from + way * along; }
};

double area_of(const model::TriangleSoup& mesh) {
  double twice = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) twice += length(twice_area(corners(mesh, t)));
  return 0.5 * twice;
}

std::optional<Crossing> crossing(const TriangleTree& tree, const SurfaceSample& sample, const Vector3& along,
                                 double least, double reach) {
  const auto hit = tree.first_hit(sample.point, along, least, reach);
  if (!hit) return std::nullopt;
  const Vector3 normal = twice_area(tree.triangles[hit->triangle]);
  return Crossing{sample.point, along, hit->distance, dot(normal, sample.normal) / length(normal)};
}

/// Of all samples, those that a condition leaves stand for the area of all that there were.
template <class Condition>
void keep(std::vector<Crossing>& crossings, double& each, const Condition& condition) {
  const std::size_t step = crossings.size() / most_verified + 1;
  std::vector<Crossing> some;
  for (std::size_t i = 0; i < crossings.size(); i += step) some.push_back(crossings[i]);
  std::vector<char> kept(some.size());
  parallel_for(count_of(some), [&](int i) { kept[i] = condition(some[i]) ? 1 : 0; });
  each *= static_cast<double>(crossings.size()) / static_cast<double>(std::max<std::size_t>(some.size(), 1));
  crossings.clear();
  for (std::size_t i = 0; i < some.size(); ++i)
    if (kept[i] != 0) crossings.push_back(some[i]);
}

/// The way across that this share of them does not exceed.
model::ThinPlaces summary(std::vector<Crossing> crossings, double each, double share) {
  if (crossings.empty()) return {};
  const auto at = crossings.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(crossings.size()));
  std::nth_element(crossings.begin(), at, crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.distance < b.distance; });
  return {each * static_cast<double>(crossings.size()), at->distance, at->at(0.5 * at->distance)};
}

using Crossings = std::vector<std::optional<Crossing>>;

/// Of each sample, towards one side.
Crossings crossings(const TriangleTree& tree, const std::vector<SurfaceSample>& samples, double side, double least,
                    double reach) {
  Crossings found(samples.size());
  constexpr int at_once = 1000;
  parallel_for((count_of(samples) + at_once - 1) / at_once, [&](int block) {
    const int end = std::min(count_of(samples), (block + 1) * at_once);
    for (int i = block * at_once; i < end; ++i)
      found[i] = crossing(tree, samples[i], side * samples[i].normal, least, reach);
  });
  return found;
}

std::vector<Crossing> parallel(const Crossings& all) {
  std::vector<Crossing> found;
  for (const auto& one : all)
    if (one && one->is_parallel()) found.push_back(*one);
  return found;
}

/// Of blocks in which ridges and grooves are a tenth of the surface each.
model::ThinPlaces relief(const std::vector<SurfaceSample>& samples, const Crossings& inwards, const Crossings& outwards,
                         double each, double voxel_mm) {
  struct Block {
    int samples = 0, ridges = 0, grooves = 0;
    std::vector<Crossing> edges;
    [[nodiscard]] bool has_relief() const { return 10 * ridges >= samples && 10 * grooves >= samples; }
  };
  constexpr double half = 0.5;       // a ridge is pointed
  constexpr double few = 12;         // samples on a plane through a block
  constexpr double least_area = 30;  // faces of a voxel
  const double side = std::max(3 * voxel_mm, std::sqrt(few * each));
  std::map<std::array<int, 3>, Block> blocks;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::array<int, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = floor_int(samples[i].point[axis] / side);
    Block& block = blocks[at];
    ++block.samples;
    for (const auto& [crossing, count] :
         {std::pair{&inwards[i], &block.ridges}, std::pair{&outwards[i], &block.grooves}}) {
      if (!*crossing || !(*crossing)->is_edge()) continue;
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
  model::ThinPlaces places = summary(std::move(edges), each, half);
  places.area_mm2 = found * each;
  return places.area_mm2 >= least_area * voxel_mm * voxel_mm ? places : model::ThinPlaces{};
}

}  // namespace

model::PartSurface part_surface(const model::TriangleSoup& mesh, const Repair& repaired, double voxel_mm) {
  const SurfaceTree surface(mesh);
  const TriangleTree& tree = *surface.tree;
  if (tree.triangles.empty()) return {};
  const double area = area_of(mesh);
  const double count = std::clamp(area / (voxel_mm * voxel_mm), least_samples, most_samples);
  const std::vector<SurfaceSample> samples = sample_surface(mesh, static_cast<int>(count));
  const double reach = model::thin_voxels * voxel_mm;
  const double touching = least_gap * voxel_mm;
  const Crossings inwards = crossings(tree, samples, -1, own * reach, reach);
  const Crossings outwards = crossings(tree, samples, 1, touching, reach);
  std::vector<Crossing> walls = parallel(inwards);
  std::vector<Crossing> gaps = parallel(outwards);
  const double each = area / static_cast<double>(samples.size());
  double of_wall = each;
  double of_gap = each;
  const bool one_surface =
      repaired.closed() && repaired.components == 1 && repaired.shared.low[0] > repaired.shared.high[0];
  if (!one_surface && !(walls.empty() && gaps.empty())) {
    const WindingNumber winding(surface.tree);
    const double beside = 0.02 * voxel_mm;
    const auto divides = [&](const Crossing& across, bool solid) {
      const auto inside = [&](double way) { return winding(across.at(way)) > 0.5; };
      return inside(0.5 * across.distance) == solid && inside(-beside) != solid &&
             inside(across.distance + beside) != solid;
    };
    keep(walls, of_wall, [&](const Crossing& across) { return divides(across, true); });
    keep(gaps, of_gap, [&](const Crossing& across) { return divides(across, false); });
  }
  constexpr double thinnest = 0.1;
  return {summary(std::move(walls), of_wall, thinnest), summary(std::move(gaps), of_gap, thinnest),
          relief(samples, inwards, outwards, each, voxel_mm),
          separate_solids(surface, repaired, samples, touching, least_solid * voxel_mm * voxel_mm * voxel_mm)};
}

}  // namespace vam::solid
