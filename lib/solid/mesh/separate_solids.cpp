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
class Connected {
 public:
  explicit Connected(const model::TriangleSoup& mesh) : parent_(mesh.points.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const auto& triangle : mesh.triangles) {
      join(triangle[0], triangle[1]);
      join(triangle[0], triangle[2]);
    }
  }
  [[nodiscard]] int root(int point) {
    while (parent_[point] != point) point = parent_[point] = parent_[parent_[point]];
    return point;
  }
  void join(int a, int b) { parent_[root(a)] = root(b); }

 private:
  std::vector<int> parent_;
};

/// Of connected points.
struct Piece {
  double volume = 0;
  int farthest = 0;  // the point of the largest x
};

/// What a point just outside a face is within: a corner of the first triangle beyond it.
std::optional<int> within(const SurfaceTree& surface, const WindingNumber& winding, const SurfaceSample& sample,
                          double near_mm, double far_mm) {
  const Vector3 beside = sample.point + near_mm * sample.normal;
  if (winding(beside) < 0.5) return std::nullopt;
  const auto hit = surface.tree->first_hit(beside, sample.normal, 0, far_mm);
  if (!hit) return std::nullopt;
  return surface.mesh.triangles[surface.places[surface.tree->order[hit->triangle]]][0];
}

}  // namespace

int separate_solids(const SurfaceTree& surface, const Repair& repaired, const std::vector<SurfaceSample>& samples,
                    double near_mm, double least_mm3) {
  const model::TriangleSoup& mesh = surface.mesh;
  if (!repaired.closed() || repaired.unorientable > 0) return 0;
  if (repaired.components == 1) return 1;
  const WindingNumber winding(surface.tree);
  const double far_mm = bounding_box(mesh).diagonal();
  Connected connected(mesh);
  std::vector<std::optional<int>> met(samples.size());
  const std::size_t step = samples.size() / most_looked_at + 1;
  parallel_for(static_cast<int>((samples.size() + step - 1) / step), [&](int n) {
    const std::size_t i = static_cast<std::size_t>(n) * step;
    met[i] = within(surface, winding, samples[i], near_mm, far_mm);
  });
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (met[i]) connected.join(mesh.triangles[samples[i].triangle][0], *met[i]);

  std::map<int, Piece> pieces;
  const Vector3 middle = bounding_box(mesh).centre();
  for (const Triangle& triangle : mesh.triangles) {
    const auto [at, is_new] = pieces.try_emplace(connected.root(triangle[0]));
    Piece& piece = at->second;
    if (is_new) piece.farthest = triangle[0];
    Measure own;
    add(own, mesh, triangle, middle);
    piece.volume += own.volume;
    for (const int corner : triangle)
      if (mesh.points[corner][0] > mesh.points[piece.farthest][0]) piece.farthest = corner;
  }
  int apart = 0;
  for (const auto& [root, piece] : pieces) {
    const Vector3 beyond = mesh.points[piece.farthest] + Vector3{near_mm, 0, 0};
    if (winding(beyond) > 0.5) continue;  // a cavity, or within another
    if (piece.volume < least_mm3) return 0;
    ++apart;
  }
  return apart;
}

}  // namespace vam::solid
