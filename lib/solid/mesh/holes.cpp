// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/holes.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/index.hpp"
#include "base/vector3.hpp"
#include "solid/mesh/private/topology.hpp"
#include "solid/mesh/private/weld.hpp"

namespace vam::solid {

namespace {

struct Lid {
  Vector3 sum{};  // of the middles of its border's edges
  double edges = 0;
  double reach_mm = 0;
  int middle = 0;  // index of a point
};

}  // namespace

long close_holes(model::TriangleSoup& mesh, double widest_mm) {
  weld_equal_points(mesh);
  drop_degenerate(mesh);
  std::vector<std::array<int, 2>> open;
  DisjointSets<int> borders(mesh.points.size());
  EdgeTable(mesh.triangles, mesh.points.size()).for_each([&](int low, std::span<const HalfEdge> edge) {
    if (edge.size() % 2 == 0) return;
    const int high = edge.front().high;
    open.push_back(edge.front().rising ? std::array{high, low} : std::array{low, high});
    borders.join(borders.of(low), borders.of(high));
  });
  std::map<int, Lid> lids;
  for (const auto& [from, to] : open) {
    Lid& lid = lids[borders.of(from)];
    lid.sum = lid.sum + 0.5 * (mesh.points[from] + mesh.points[to]);
    ++lid.edges;
  }
  for (auto& [border, lid] : lids) {
    lid.middle = count_of(mesh.points);
    mesh.points.push_back((1 / lid.edges) * lid.sum);
  }
  for (const auto& [from, to] : open) {
    Lid& lid = lids[borders.of(from)];
    lid.reach_mm = std::max(lid.reach_mm, length(mesh.points[from] - mesh.points[lid.middle]));
  }
  for (const auto& [from, to] : open) {
    const Lid& lid = lids[borders.of(from)];
    if (2 * lid.reach_mm <= widest_mm) mesh.triangles.push_back({from, to, lid.middle});
  }
  return static_cast<long>(open.size());
}

}  // namespace vam::solid
