// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/holes.hpp"

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
  int middle = 0;  // index of a point
};

}  // namespace

long close_holes(model::TriangleSoup& mesh) {
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
  for (const auto& [from, to] : open) mesh.triangles.push_back({from, to, lids[borders.of(from)].middle});
  return static_cast<long>(open.size());
}

}  // namespace vam::solid
