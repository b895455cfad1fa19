// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/repair.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"
#include "base/vector3.hpp"
#include "solid/mesh/private/topology.hpp"

namespace vam::solid {

namespace {

/// A box around all that two of the boxes share; empty when they only touch.
Bounds overlap(std::vector<Bounds> boxes) {
  // Sweep along x: only boxes that begin before another ends can share something with it.
  std::sort(boxes.begin(), boxes.end(), [](const Bounds& a, const Bounds& b) { return a.low < b.low; });
  Bounds all;
  for (auto a = boxes.begin(); a != boxes.end(); ++a) {
    if (all.contains(*a)) continue;
    for (auto b = a + 1; b != boxes.end() && b->low[0] < a->high[0]; ++b) {
      Bounds both;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        both.low[axis] = std::max(a->low[axis], b->low[axis]);
        both.high[axis] = std::min(a->high[axis], b->high[axis]);
      }
      const Point size = both.size();
      if (size[0] > 0 && size[1] > 0 && size[2] > 0) all.join(both);
    }
  }
  return all;
}

void drop(model::TriangleSoup& mesh, Repair& done) {
  done.degenerate_dropped += drop_degenerate(mesh);
  done.duplicates_dropped += drop_duplicates(mesh);
}

struct Border {
  std::vector<int> points;      // of boundary edges
  std::vector<double> lengths;  // of those edges
};

Border border(const model::TriangleSoup& mesh) {
  Border result;
  for_each_edge(mesh.triangles, mesh.points.size(), [&](int low, std::span<const HalfEdge> edge) {
    if (edge.size() % 2 == 0) return;
    const int high = edge.front().high;
    result.points.push_back(low);
    result.points.push_back(high);
    result.lengths.push_back(length(mesh.points[low] - mesh.points[high]));
  });
  std::sort(result.points.begin(), result.points.end());
  result.points.erase(std::unique(result.points.begin(), result.points.end()), result.points.end());
  return result;
}

// Cracks: borders that lie on each other up to rounding. Features are safe, as nothing but borders is joined and the
// distance stays far below the border's own edges.
void close_cracks(model::TriangleSoup& mesh, Repair& done) {
  Border open = border(mesh);
  if (open.points.empty()) return;
  Bounds bounds;
  for (const Point& p : mesh.points) bounds.add(p);
  const double distance = std::min(1e-4 * bounds.diagonal(), 0.2 * stats::median(open.lengths));
  const long welded = weld_near_points(mesh, open.points, distance);
  if (welded == 0) return;
  done.points_welded += welded;
  done.weld_distance = distance;
  drop(mesh, done);
}

void count_edges(const model::TriangleSoup& mesh, Repair& done) {
  for_each_edge(mesh.triangles, mesh.points.size(), [&](int, std::span<const HalfEdge> edge) {
    const auto rising = std::count_if(edge.begin(), edge.end(), [](const HalfEdge& half) { return half.rising; });
    if (edge.size() % 2 != 0) ++done.boundary_edges;
    if (edge.size() > 2) ++done.non_manifold_edges;
    if (2 * rising != static_cast<std::ptrdiff_t>(edge.size())) ++done.unbalanced_edges;
  });
}

}  // namespace

Repair repair(model::TriangleSoup& mesh, const std::string& subject) {
  Repair done;
  done.points_welded = weld_equal_points(mesh);
  drop(mesh, done);
  close_cracks(mesh, done);
  if (mesh.triangles.empty())
    throw Error{Fault::data, subject + ": all triangles are degenerate; the mesh has no surface"};
  const Orientation orientation = orient(mesh);
  done.flipped = orientation.flipped;
  done.components = orientation.components;
  done.cavities = orientation.cavities;
  done.unorientable = orientation.unorientable;
  count_edges(mesh, done);
  done.shared = done.non_manifold_edges > 0 ? bounding_box(mesh) : overlap(orientation.outward);
  return done;
}

bool Repair::changed() const { return weld_distance > 0 || degenerate_dropped + duplicates_dropped + flipped > 0; }

std::string Repair::summary() const {
  std::vector<std::string> parts;
  const auto say = [&](long count, const std::string& before, const std::string& after) {
    if (count > 0) parts.push_back(before + std::to_string(count) + after);
  };
  if (weld_distance > 0) parts.push_back("closed cracks of up to " + format_number(weld_distance, 3) + " mm");
  say(degenerate_dropped, "dropped ", " degenerate triangles");
  say(duplicates_dropped, "dropped ", " duplicate triangles");
  say(flipped, "turned over ", " triangles");
  say(boundary_edges, "", " boundary edges remain");
  say(non_manifold_edges, "", " non-manifold edges (more than two triangles)");
  say(unorientable, "", " edges cannot be oriented");
  return join(parts, ", ");
}

long duplicate_triangles(model::TriangleSoup mesh) {
  weld_equal_points(mesh);
  drop_degenerate(mesh);
  return drop_duplicates(mesh);
}

long close_holes(model::TriangleSoup& mesh, double widest_mm) {
  weld_equal_points(mesh);
  drop_degenerate(mesh);
  std::vector<std::array<int, 2>> open;
  DisjointSets<int> borders(mesh.points.size());
  for_each_edge(mesh.triangles, mesh.points.size(), [&](int low, std::span<const HalfEdge> edge) {
    if (edge.size() % 2 == 0) return;
    const int high = edge.front().high;
    open.push_back(edge.front().rising ? std::array{high, low} : std::array{low, high});
    borders.join(borders.of(low), borders.of(high));
  });
  std::map<int, std::vector<std::array<int, 2>>> holes;  // by their borders
  for (const auto& edge : open) holes[borders.of(edge[0])].push_back(edge);
  for (const auto& [border, edges] : holes) {
    Vector3 middle{};
    for (const auto& [from, to] : edges) middle = middle + 0.5 * (mesh.points[from] + mesh.points[to]);
    middle = (1 / static_cast<double>(edges.size())) * middle;
    double reach_mm = 0;
    for (const auto& [from, to] : edges) reach_mm = std::max(reach_mm, length(mesh.points[from] - middle));
    if (2 * reach_mm > widest_mm) continue;
    for (const auto& [from, to] : edges) mesh.triangles.push_back({from, to, count_of(mesh.points)});
    mesh.points.push_back(middle);
  }
  return static_cast<long>(open.size());
}

}  // namespace vam::solid
