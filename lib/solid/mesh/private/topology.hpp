// SPDX-License-Identifier: GPL-3.0-or-later
// Who shares an edge with whom in a triangle soup with welded points, and the steps of its repair: points that are
// meant to be one become one; triangles that are none, or there twice, go; components are oriented.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/buckets.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/geometry.hpp"

namespace vam::solid {

using Triangle = std::array<int, 3>;

/// One side of a triangle: from corner `side` to the next.
struct HalfEdge {
  int high = 0;  // the edge's larger point index
  int triangle = 0;
  int side = 0;
  bool rising = false;  // runs from the lower index to the higher
};

/// By the lower point, in the order of the higher.
[[nodiscard]] Buckets<HalfEdge> half_edges(std::span<const Triangle> triangles, std::size_t points);

/// Calls visit(low, half_edges) for every edge, by ascending point indices.
template <typename Visit>
void for_each_edge(std::span<const Triangle> triangles, std::size_t points, const Visit& visit) {
  const Buckets<HalfEdge> by_low = half_edges(triangles, points);
  for (std::size_t low = 0; low < points; ++low) {
    std::span<const HalfEdge> rest = by_low[low];
    while (!rest.empty()) {
      std::size_t same = 1;
      while (same < rest.size() && rest[same].high == rest[0].high) ++same;
      visit(static_cast<int>(low), rest.first(same));
      rest = rest.subspan(same);
    }
  }
}

/// Signed volume, area and the like of a set of triangles.
struct Measure {
  double volume = 0;  // about the origin given; positive when normals point outwards
  double area = 0;
  std::array<double, 3> vector_area{};  // 0 for a closed surface
};
void add(Measure& measure, const model::TriangleSoup& mesh, const Triangle& triangle,
         const std::array<double, 3>& origin);

/// Gives points with the same coordinates one index and removes unused points. Returns how many went.
long weld_equal_points(model::TriangleSoup& mesh);

/// Joins each of `candidates` (point indices) to an earlier candidate within `distance`, if there is one. Returns how
/// many points went. Candidates are few (border points), so the time is that of a sort.
long weld_near_points(model::TriangleSoup& mesh, std::span<const int> candidates, double distance);

/// Removes triangles that use a point twice. Returns how many went.
long drop_degenerate(model::TriangleSoup& mesh);

/// Of triangles with the same three points keeps one, with the orientation that most of them have, and further ones
/// where these balance edges, as where two overlapping solids end in one face. Where as many run
/// one way round as the other they cancel: patches of such go altogether if the other triangles are closed without
/// them. Returns how many went.
long drop_duplicates(model::TriangleSoup& mesh);

struct Orientation {
  long flipped = 0;
  long components = 0;
  long cavities = 0;
  long unorientable = 0;        // edges with two triangles that cannot agree
  std::vector<Bounds> outward;  // boxes of the components, but for those that face inwards
};

/// Orients in place; see repair().
Orientation orient(model::TriangleSoup& mesh);

}  // namespace vam::solid
