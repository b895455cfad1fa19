// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/isosurface.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.hpp"

using namespace vam;

namespace {

/// radius - distance from (0.3, -0.2, 0.1): its zero is a sphere.
model::Volume ball(double radius_mm, double voxel_mm, int n) {
  model::Volume volume{model::centred_grid(n, n, n, voxel_mm, -0.5 * (n - 1) * voxel_mm), {}};
  const auto& g = volume.grid;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        volume.values.push_back(
            static_cast<float>(10 + radius_mm - std::hypot(g.x_mm(i) - 0.3, g.y_mm(j) + 0.2, g.z_mm(k) - 0.1)));
      }
    }
  }
  return volume;
}

double signed_volume(const model::TriangleSoup& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto& a = mesh.points[t[0]];
    const auto& b = mesh.points[t[1]];
    const auto& c = mesh.points[t[2]];
    sum +=
        (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) /
        6;
  }
  return sum;
}

bool closed(const model::TriangleSoup& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t e = 0; e < 3; ++e) ++edges[{t[e], t[(e + 1) % 3]}];
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto back = edges.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != edges.end();
  });
}

}  // namespace

TEST_CASE("a ball: closed, outward, its volume, its vertices on the sphere") {
  const double radius = 4;
  const auto mesh = solid::isosurface(ball(radius, 0.25, 48), 10);
  CHECK(closed(mesh));
  CHECK(signed_volume(mesh) == doctest::Approx(4.0 / 3 * std::numbers::pi * radius * radius * radius).epsilon(0.005));
  double worst = 0;
  for (const auto& p : mesh.points)
    worst = std::max(worst, std::abs(std::hypot(p[0] - 0.3, p[1] + 0.2, p[2] - 0.1) - radius));
  CHECK(worst < 0.1 * 0.25);  // dual vertices lie inside their cell; a tenth of a voxel at this curvature
}

TEST_CASE("a surface closes at the grid's border") {
  const auto mesh = solid::isosurface(ball(8, 0.25, 48), 10);  // reaches beyond the 12 mm cube in the corners only
  CHECK(closed(mesh));
  CHECK(signed_volume(mesh) > 0);
}

TEST_CASE("nothing above the level is an empty mesh; invalid levels are refused") {
  const auto volume = ball(4, 0.5, 24);
  CHECK(solid::isosurface(volume, 1000).triangles.empty());
  CHECK_THROWS_AS((void)solid::isosurface(volume, std::nan("")), Error);
  auto broken = volume;
  broken.values[100] = std::nanf("");
  CHECK_THROWS_WITH_AS((void)solid::isosurface(broken, 10), doctest::Contains("not finite"), Error);
}

TEST_CASE("printed points are the voxels at or above the level, with their dose") {
  const auto volume = ball(4, 0.5, 24);
  const auto read = [&](int k, int count, float* out) {
    std::copy_n(volume.slice(k), volume.grid.slice_size() * static_cast<std::size_t>(count), out);
  };
  const auto print = solid::printed_points(volume.grid, read, 10);
  const auto want = std::count_if(volume.values.begin(), volume.values.end(), [](float v) { return v >= 10; });
  CHECK(static_cast<long>(print.points.points.size()) == want);
  CHECK(print.values.quality.size() == print.points.points.size());
  CHECK(print.points.triangles.empty());
}
