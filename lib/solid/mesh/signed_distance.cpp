// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/signed_distance.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/log/progress.hpp"
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

namespace {

constexpr int block_edge = 6;  // voxels of a block

struct VoxelSpan {
  int first;
  int last;  // beyond
  [[nodiscard]] double middle() const { return 0.5 * (first + last - 1); }
};

VoxelSpan span_of(int block, int voxels) { return {block * block_edge, std::min(voxels, (block + 1) * block_edge)}; }

// Signed distances at points along a way: the side is asked for only where it may have changed, as a distance does not
// change by more than the way.
class WayAlong {
 public:
  explicit WayAlong(const Surface& surface) : surface_(surface) {}

  double operator()(const Vector3& point) {
    const ClosestPoint foot = surface_.closest(point, start_);
    start_ = foot.triangle;
    const double distance = length(point - foot.point);
    const bool may_cross = !begun_ || distance + distance_ <= length(point - point_) * (1 + 1e-9);
    if (may_cross) outside_ = surface_.signed_distance(point) > 0;
    begun_ = true;
    distance_ = distance;
    point_ = point;
    return outside_ ? distance : -distance;
  }

 private:
  const Surface& surface_;
  bool begun_ = false;
  bool outside_ = true;
  int start_ = 0;
  double distance_ = 0;
  Vector3 point_{};
};

}  // namespace

model::Volume distance_band(const Surface& surface, const model::Grid& grid, double band_mm) {
  model::Volume volume{grid, std::vector<float>(grid.size())};
  const auto blocks = [](int voxels) { return (voxels + block_edge - 1) / block_edge; };
  const int across = blocks(grid.nx);
  const int along = blocks(grid.ny);
  const double reach_mm = band_mm + 0.5 * std::sqrt(3.0) * block_edge * grid.voxel_mm;
  const int count = across * along * blocks(grid.nz);
  Progress progress("measuring distances", count);
  parallel_for(count, [&](int n) {
    const VoxelSpan x = span_of(n % across, grid.nx);
    const VoxelSpan y = span_of(n / across % along, grid.ny);
    const VoxelSpan z = span_of(n / across / along, grid.nz);
    WayAlong at(surface);
    const double middle = at({grid.x_mm(x.middle()), grid.y_mm(y.middle()), grid.z_mm(z.middle())});
    const bool far = std::abs(middle) > reach_mm;
    for (int k = z.first; k < z.last; ++k) {
      for (int j = y.first; j < y.last; ++j) {
        float* row = volume.slice(k) + std::ptrdiff_t{j} * grid.nx;
        double distance = middle;
        int beyond = far ? block_edge : 0;  // voxels of the row that are farther than the band, as the one before tells
        for (int i = x.first; i < x.last; ++i) {
          if (beyond-- <= 0) {
            distance = at({grid.x_mm(i), grid.y_mm(j), grid.z_mm(k)});
            beyond = static_cast<int>(std::max(0.0, (std::abs(distance) - band_mm) / grid.voxel_mm));
          }
          row[i] = static_cast<float>(std::clamp(distance, -band_mm, band_mm));
        }
      }
    }
    progress.tick();
  });
  return volume;
}

}  // namespace vam::solid
