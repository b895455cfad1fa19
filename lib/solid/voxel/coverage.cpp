// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/private/coverage.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace vam::solid {

namespace {

constexpr double rounding = 1e-6;

// The part of a triangle between the planes z = 0 and z = nz, in triangles.
void add_between(const TriangleCorners& corners, int nz, std::vector<TriangleCorners>& triangles) {
  Polygon below;
  Polygon rest;
  Polygon inside;
  Polygon above;
  split(polygon(corners), 2, 0, below, rest);
  split(rest, 2, nz, inside, above);
  for (int i = 1; i + 1 < inside.count; ++i) {
    const auto c = static_cast<std::size_t>(i);
    triangles.push_back({inside.corners[0], inside.corners[c], inside.corners[c + 1]});
  }
}

}  // namespace

std::vector<TriangleCorners> in_voxels(const model::TriangleSoup& mesh, const model::Grid& grid) {
  std::vector<Vector3> points(mesh.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) points[i][a] = (mesh.points[i][a] - grid.origin_mm[a]) / grid.voxel_mm + 0.5;
    const auto within = [&](std::size_t a, int size) {
      return points[i][a] > -rounding && points[i][a] < size + rounding;
    };
    if (!within(0, grid.nx) || !within(1, grid.ny)) throw Error{Fault::bug, "voxelize: the mesh leaves its grid"};
  }
  std::vector<TriangleCorners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    TriangleCorners corners{};
    for (std::size_t c = 0; c < 3; ++c) corners[c] = points[triangle[c]];
    const double low = std::min({corners[0][2], corners[1][2], corners[2][2]});
    const double high = std::max({corners[0][2], corners[1][2], corners[2][2]});
    if (low > -rounding && high < grid.nz + rounding) {
      triangles.push_back(corners);
    } else if (low < grid.nz && high > 0) {
      add_between(corners, grid.nz, triangles);
    }
  }
  return triangles;
}

Polygon polygon(const TriangleCorners& corners) {
  Polygon result;
  for (const Vector3& corner : corners) result.add(corner);
  return result;
}

Buckets<int> by_layer(const std::vector<TriangleCorners>& triangles, std::size_t axis, int layers) {
  return {static_cast<std::size_t>(layers), [&](const auto& put) {
            for (int i = 0; i < count_of(triangles); ++i) {
              const auto& [a, b, c] = triangles[i];
              const auto [low, high] = std::minmax({a[axis], b[axis], c[axis]});
              const Span span = span_of(low, high, layers);
              for (int k = span.first; k <= span.last; ++k) put(k, i);
            }
          }};
}

Moment moment(const Polygon& piece, std::size_t axis) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const Vector3& a = piece.corners[0];
  Moment result;
  for (int i = 1; i + 1 < piece.count; ++i) {
    const Vector3& b = piece.corners[i];
    const Vector3& c = piece.corners[i + 1];
    const double area = 0.5 * ((b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]));
    result.area += area;
    result.first += area * (a[axis] + b[axis] + c[axis]) / 3;
  }
  return result;
}

void VoxelRows::reset(int rows, int voxels) {
  length_ = voxels + 1;
  values_.resize(rows * static_cast<std::size_t>(length_));
  touched_.assign(rows, 0);
}

double* VoxelRows::operator[](int row) {
  double* begin = values_.data() + static_cast<std::ptrdiff_t>(row) * length_;
  if (!touched(row)) {
    touched_[row] = 1;
    std::fill(begin, begin + length_, 0.0);
  }
  return begin;
}

double VoxelRows::accumulate(int row) {
  double* entry = (*this)[row];
  double sum = 0;
  for (int i = 0; i < length_; ++i) entry[i] = sum += entry[i];
  return sum;
}

}  // namespace vam::solid
