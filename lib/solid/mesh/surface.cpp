// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/surface.hpp"

#include <algorithm>
#include <random>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "solid/mesh/private/triangle_tree.hpp"
#include "solid/mesh/private/winding.hpp"

namespace vam::solid {

namespace {

TriangleCorners corners(const model::TriangleSoup& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

Vector3 twice_area(const TriangleCorners& c) { return cross(c[1] - c[0], c[2] - c[0]); }

// In parallel; `start` is the triangle of the point before, as neighbours in a list are mostly neighbours in space.
template <class Work>
void for_chunks(std::size_t count, const Work& work) {
  constexpr std::size_t chunk = 1024;
  parallel_for(static_cast<int>((count + chunk - 1) / chunk), [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * chunk;
    int start = 0;
    for (std::size_t i = begin; i < std::min(count, begin + chunk); ++i) work(i, start);
  });
}

}  // namespace

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

Foot Surface::closest(const Vector3& point, int start) const {
  const Nearest nearest = state_->tree->nearest(point, start);
  const Vector3 normal = twice_area(state_->tree->triangles[nearest.triangle]);
  return {nearest.point, (1 / length(normal)) * normal, nearest.triangle};
}

std::vector<Foot> Surface::closest(std::span<const Vector3> points) const {
  std::vector<Foot> feet(points.size());
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

std::vector<SurfaceSample> sample_surface(const model::TriangleSoup& mesh, int count) {
  std::vector<double> running(mesh.triangles.size());
  double total = 0;
  for (std::size_t i = 0; i < running.size(); ++i) running[i] = total += length(twice_area(corners(mesh, i)));
  std::vector<SurfaceSample> samples;
  if (!(total > 0)) return samples;
  samples.reserve(count);
  std::mt19937 random(20220613);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t triangle = 0;
  for (int s = 0; s < count; ++s) {
    const double at = (s + unit(random)) / count * total;
    while (triangle + 1 < running.size() && running[triangle] < at) ++triangle;
    const TriangleCorners c = corners(mesh, triangle);
    const Vector3 normal = twice_area(c);
    const double area = length(normal);
    if (!(area > 0)) continue;
    const double root = std::sqrt(unit(random));  // uniform in the triangle
    const double along = unit(random);
    const Vector3 point = (1 - root) * c[0] + root * (1 - along) * c[1] + root * along * c[2];
    samples.push_back({point, (1 / area) * normal, static_cast<int>(triangle)});
  }
  return samples;
}

double Box::largest_side() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }

Box bounding_box(const model::TriangleSoup& mesh) {
  Box box{mesh.points.front(), mesh.points.front()};
  for (const auto& t : mesh.triangles) {
    for (const int index : t) {
      const Vector3& p = mesh.points[index];
      for (std::size_t d = 0; d < 3; ++d) {
        box.low[d] = std::min(box.low[d], p[d]);
        box.high[d] = std::max(box.high[d], p[d]);
      }
    }
  }
  return box;
}

}  // namespace vam::solid
