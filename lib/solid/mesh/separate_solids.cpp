// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/separate_solids.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/index.hpp"
#include "solid/mesh/private/topology.hpp"

namespace vam::solid {

namespace {

/// For each point: the representative of its connected points.
std::vector<int> roots(DisjointSets<int>& connected) {
  std::vector<int> all(connected.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = connected.of(static_cast<int>(i));
  return all;
}

/// Of connected points.
struct Piece {
  Measure measure;
  int farthest = 0;  // the point of the largest x
};

/// A piece's own triangles, and those of others, of a tree.
class Pieces {
 public:
  Pieces(const SurfaceTree& surface, std::vector<int> piece_of) : surface_(surface), piece_of_(std::move(piece_of)) {}
  /// By a triangle of the mesh.
  [[nodiscard]] int piece(int triangle) const { return piece_of_[surface_.point_of(triangle)]; }
  /// Adds triangles on this way: one of each other piece that `found` has none of.
  void add_others(int own, const Vector3& from, const Vector3& to, std::vector<int>& found) const {
    const Vector3 way = to - from;
    const double far = length(way);
    if (!(far > 0)) return;
    const auto is_new = [&](int triangle) {
      const int other = piece(surface_.place(triangle));
      return other != own && std::none_of(found.begin(), found.end(), [&](int one) { return piece(one) == other; });
    };
    while (const auto hit = surface_.tree->first_hit(from, (1 / far) * way, 0, far, is_new))
      found.push_back(surface_.place(hit->triangle));
  }

 private:
  const SurfaceTree& surface_;
  std::vector<int> piece_of_;  // of each point
};

/// For each triangle in the box: one crossed triangle of each other piece.
std::vector<std::vector<int>> crossed(const model::TriangleSoup& mesh, const Pieces& pieces, const Bounds& box) {
  std::vector<std::vector<int>> found(mesh.triangles.size());
  for_chunks(found.size(), [&](std::size_t t, int) {
    const TriangleCorners c = corners(mesh, t);
    Bounds own;
    for (const Vector3& corner : c) own.add(corner);
    for (std::size_t side = 0; side < 3 && own.meets(box); ++side)
      pieces.add_others(pieces.piece(static_cast<int>(t)), c[side], c[(side + 1) % 3], found[t]);
  });
  return found;
}

/// For each point of the mesh: the representative of its solid.
std::vector<int> solids_of_points(const SurfaceTree& surface, const Bounds& shared,
                                  const std::vector<SurfaceSample>& samples, double near_mm) {
  DisjointSets<int> connected(surface.mesh.points.size());
  const auto join = [&](int a, int b) { connected.join(connected.of(b), connected.of(a)); };
  for (const Triangle& triangle : surface.mesh.triangles) {
    join(triangle[0], triangle[1]);
    join(triangle[0], triangle[2]);
  }
  const Pieces pieces(surface, roots(connected));
  const std::vector<std::vector<int>> crossing = crossed(surface.mesh, pieces, shared);
  std::vector<std::vector<int>> touching(samples.size());
  for_chunks(samples.size(), [&](std::size_t i, int) {
    const Vector3 near = near_mm * samples[i].normal;
    pieces.add_others(pieces.piece(samples[i].triangle), samples[i].point - near, samples[i].point + near, touching[i]);
  });
  for (int t = 0; t < count_of(crossing); ++t)
    for (const int other : crossing[t]) join(surface.point_of(t), surface.point_of(other));
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (const int other : touching[i]) join(surface.point_of(samples[i].triangle), surface.point_of(other));
  return roots(connected);
}

}  // namespace

SeparateSolids separate_solids(const SurfaceTree& surface, const Repair& repaired,
                               const std::vector<SurfaceSample>& samples, double near_mm, double least_mm3) {
  if (!repaired.closed() || repaired.unorientable > 0) return {};
  if (repaired.components == 1) return {1, 0, {}};
  const model::TriangleSoup& mesh = surface.mesh;
  SeparateSolids found{0, 0, solids_of_points(surface, repaired.shared, samples, near_mm)};
  const Vector3 middle = bounding_box(mesh).centre();
  std::map<int, Piece> pieces;
  for (const Triangle& triangle : mesh.triangles) {
    const auto [at, is_new] = pieces.try_emplace(found.of_points[triangle[0]]);
    Piece& piece = at->second;
    if (is_new) piece.farthest = triangle[0];
    add(piece.measure, mesh, triangle, middle);
    for (const int corner : triangle)
      if (mesh.points[corner][0] > mesh.points[piece.farthest][0]) piece.farthest = corner;
  }
  for (const auto& [point, piece] : pieces) {
    const Vector3 beyond = mesh.points[piece.farthest] + Vector3{near_mm, 0, 0};
    if (surface.winding()(beyond) > 0.5) continue;  // a cavity, or within another
    ++found.count;
    found.specks += piece.measure.volume < least_mm3 ? 1 : 0;
  }
  return found;
}

}  // namespace vam::solid
