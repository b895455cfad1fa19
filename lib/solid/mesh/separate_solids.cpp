// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/separate_solids.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "solid/mesh/private/topology.hpp"
#include "solid/mesh/private/winding.hpp"

namespace vam::solid {

namespace {

constexpr std::size_t most_looked_at = 10'000;

/// Points of a mesh that triangles connect.
class ConnectedPoints {
 public:
  explicit ConnectedPoints(const model::TriangleSoup& mesh) : parent_(mesh.points.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const Triangle& triangle : mesh.triangles) {
      join(triangle[0], triangle[1]);
      join(triangle[0], triangle[2]);
    }
  }
  void join(int a, int b) { parent_[root(a)] = root(b); }
  /// Of each point, the one that stands for all it is connected with.
  [[nodiscard]] std::vector<int> roots() {
    std::vector<int> all(parent_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = root(static_cast<int>(i));
    return all;
  }

 private:
  int root(int point) {
    while (parent_[point] != point) point = parent_[point] = parent_[parent_[point]];
    return point;
  }
  std::vector<int> parent_;
};

/// Of connected points.
struct Piece {
  double volume = 0;
  int farthest = 0;  // the point of the largest x
};

/// What a face touches or lies within: a triangle of it.
std::optional<int> met_by(const SurfaceTree& surface, const std::vector<int>& piece, const WindingNumber& winding,
                          const SurfaceSample& sample, double near_mm, double far_mm) {
  constexpr double own = 1e-6;
  const auto close = surface.tree->first_hit(sample.point, sample.normal, own * near_mm, near_mm);
  if (close) {
    const int place = surface.place(close->triangle);
    const auto& triangles = surface.mesh.triangles;
    if (piece[triangles[place][0]] != piece[triangles[sample.triangle][0]]) return place;
  }
  const Vector3 beside = sample.point + near_mm * sample.normal;
  if (winding(beside) < 0.5) return std::nullopt;
  const auto hit = surface.tree->first_hit(beside, sample.normal, 0, far_mm);
  if (!hit) return std::nullopt;
  return surface.place(hit->triangle);
}

}  // namespace

SeparateSolids::SeparateSolids(const SurfaceTree& surface, const Repair& repaired,
                               const std::vector<SurfaceSample>& samples, double near_mm, double least_mm3)
    : mesh_(surface.mesh) {
  if (!repaired.closed() || repaired.unorientable > 0) return;
  count_ = 1;
  if (repaired.components > 1) find(surface, samples, near_mm, least_mm3);
}

void SeparateSolids::find(const SurfaceTree& surface, const std::vector<SurfaceSample>& samples, double near_mm,
                          double least_mm3) {
  const WindingNumber winding(surface.tree);
  const Bounds bounds = bounding_box(mesh_);
  ConnectedPoints connected(mesh_);
  const auto point_of = [&](int triangle) { return mesh_.triangles[triangle][0]; };
  std::vector<std::optional<int>> met(samples.size());
  const std::vector<int> piece_of = connected.roots();
  const std::size_t step = samples.size() / most_looked_at + 1;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < samples.size(); i += step) some.push_back(i);
  parallel_for(count_of(some), [&](int n) {
    met[some[n]] = met_by(surface, piece_of, winding, samples[some[n]], near_mm, bounds.diagonal());
  });
  for (const std::size_t i : some)
    if (met[i]) connected.join(point_of(samples[i].triangle), point_of(*met[i]));

  solid_ = connected.roots();
  std::map<int, Piece> pieces;
  for (const Triangle& triangle : mesh_.triangles) {
    const auto [at, is_new] = pieces.try_emplace(solid_[triangle[0]]);
    Piece& piece = at->second;
    if (is_new) piece.farthest = triangle[0];
    Measure own;
    add(own, mesh_, triangle, bounds.centre());
    piece.volume += own.volume;
    for (const int corner : triangle)
      if (mesh_.points[corner][0] > mesh_.points[piece.farthest][0]) piece.farthest = corner;
  }
  count_ = 0;
  for (const auto& [point, piece] : pieces) {
    const Vector3 beyond = mesh_.points[piece.farthest] + Vector3{near_mm, 0, 0};
    if (winding(beyond) > 0.5) continue;  // a cavity, or within another
    ++count_;
    specks_ += piece.volume < least_mm3 ? 1 : 0;
  }
}

}  // namespace vam::solid
