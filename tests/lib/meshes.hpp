// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that tests make for themselves.
#pragma once

#include <cmath>
#include <numbers>

#include "base/vector3.hpp"
#include "model/mesh.hpp"

namespace vam::test {

/// A closed surface by latitude and longitude, 2 rings (rings + 1) points and 4 rings (rings - 1) outward triangles;
/// place(theta, phi) gives its points.
template <class Place>
model::TriangleSoup globe(int rings, const Place& place) {
  model::TriangleSoup mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < around; ++j) {
      mesh.points.push_back(place(std::numbers::pi * i / rings, 2 * std::numbers::pi * j / around));
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

inline model::TriangleSoup sphere(const Vector3& centre, double radius, int rings) {
  return globe(rings, [&](double theta, double phi) -> Vector3 {
    return {centre[0] + radius * std::sin(theta) * std::cos(phi), centre[1] + radius * std::sin(theta) * std::sin(phi),
            centre[2] + radius * std::cos(theta)};
  });
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
