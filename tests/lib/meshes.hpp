// Meshes that tests make for themselves.
#pragma once

#include <cmath>
#include <numbers>

#include "base/vector3.hpp"
#include "model/mesh.hpp"

namespace vam::test {

/// A sphere by latitude and longitude with 4 * rings * (rings - 1) outward triangles.
inline model::TriangleSoup sphere(const Vector3& centre, double radius, int rings) {
  model::TriangleSoup mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const double theta = std::numbers::pi * i / rings;
      const double phi = 2 * std::numbers::pi * j / around;
      mesh.points.push_back({centre[0] + radius * std::sin(theta) * std::cos(phi),
                             centre[1] + radius * std::sin(theta) * std::sin(phi),
                             centre[2] + radius * std::cos(theta)});
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j;
      const int b = i * around + (j + 1) % around;
      if (i > 0) mesh.triangles.push_back({a, a + around, b});
      if (i + 1 < rings) mesh.triangles.push_back({b, a + around, b + around});
    }
  }
  return mesh;
}

/// Adds the box [low, high] with 12 outward triangles.
inline void add_box(const Vector3& low, const Vector3& high, model::TriangleSoup& mesh) {
  const int first = static_cast<int>(mesh.points.size());
  for (int k = 0; k < 8; ++k) {
    mesh.points.push_back(
        {(k & 1) != 0 ? high[0] : low[0], (k & 2) != 0 ? high[1] : low[1], (k & 4) != 0 ? high[2] : low[2]});
  }
  const int faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& f : faces) mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
}

}  // namespace vam::test
