// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/surface_samples.hpp"

#include <cmath>
#include <random>

#include "solid/mesh/private/triangle_tree.hpp"

namespace vam::solid {

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

}  // namespace vam::solid
