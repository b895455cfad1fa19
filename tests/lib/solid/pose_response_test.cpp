// SPDX-License-Identifier: GPL-3.0-or-later
// What errors of a surface do to the pose of its alignment.
#include "solid/mesh/pose_response.hpp"

#include "lib/meshes.hpp"
#include "solid/mesh/surface_samples.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

TEST_CASE("the pose that reduces the distances of a turned, shifted and grown part takes them away, wherever it lies") {
  model::TriangleSoup box;
  test::add_box({-5, -4, -2}, {5, 4, 2}, box);
  const Vector3 turn{0.002, -0.001, 0.003};
  for (const double far_mm : {0.0, 3000.0}) {
    CAPTURE(far_mm);
    model::TriangleSoup part = box;
    for (Vector3& p : part.points) p = p + Vector3{far_mm, -far_mm, 0.5 * far_mm};
    const std::vector<SurfaceSample> points = sample_surface(part, 4000);
    Vector3 middle{};
    for (const auto& p : points) middle = middle + (1.0 / static_cast<double>(points.size())) * p.point;
    std::vector<double> distances_mm;
    for (const auto& p : points) {
      const Vector3 arm = p.point - middle;
      distances_mm.push_back(dot(p.normal, cross(turn, arm) + Vector3{0.01, 0.02, -0.01} + 0.001 * arm));
    }
    const PoseResponse response(points, true);
    const auto motion = response.of(distances_mm);
    for (std::size_t i = 0; i < points.size(); ++i) {
      CHECK(std::abs(distances_mm[i] + response.at(motion, points[i])) < 1e-6);
    }
  }
}
