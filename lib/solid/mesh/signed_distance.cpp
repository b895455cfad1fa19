// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/signed_distance.hpp"

#include <cmath>

#include "base/error.hpp"
#include "solid/mesh/private/triangle_tree.hpp"

namespace vam::solid {

struct Surface::State {
  std::shared_ptr<const TriangleTree> tree;
  WindingNumber winding;

  explicit State(const model::TriangleSoup& mesh)
      : tree(std::make_shared<const TriangleTree>(corners_of(mesh))), winding(tree) {
    if (tree->triangles.empty()) throw Error{Fault::data, "the reference surface has no triangle with an area"};
  }
};

Surface::Surface(const model::TriangleSoup& mesh) : state_(std::make_unique<State>(mesh)) {}
Surface::~Surface() = default;

ClosestPoint Surface::closest(const Vector3& point, int start) const {
  const Nearest nearest = state_->tree->nearest(point, start);
  const Vector3 normal = twice_area(state_->tree->triangles[nearest.triangle]);
  return {nearest.point, (1 / length(normal)) * normal, nearest.triangle};
}

std::vector<ClosestPoint> Surface::closest(std::span<const Vector3> points) const {
  std::vector<ClosestPoint> feet(points.size());
  for_chunks(points.size(), [&](std::size_t i, int& start) {
    feet[i] = closest(points[i], start);
    start = feet[i].triangle;
  });
  return feet;
}

double Surface::signed_distance(const Vector3& point) const {
  const double distance = std::sqrt(state_->tree->nearest(point).distance2);
  return state_->winding(point) > 0.5 ? -distance : distance;
}

std::vector<float> Surface::signed_distances(std::span<const Vector3> points) const {
  std::vector<float> distances(points.size());
  for_chunks(points.size(), [&](std::size_t i, int& start) {
    const Nearest nearest = state_->tree->nearest(points[i], start);
    start = nearest.triangle;
    const auto distance = static_cast<float>(std::sqrt(nearest.distance2));
    distances[i] = state_->winding(points[i]) > 0.5 ? -distance : distance;
  });
  return distances;
}

}  // namespace vam::solid
