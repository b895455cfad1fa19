// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/isosurface.hpp"

#include <map>

#include "oracle/meshes.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

/// radius - distance from (0.3, -0.2, 0.1): its zero is a sphere.
model::Volume ball(double radius_mm, double voxel_mm, int n) {
  model::Volume volume{model::centred_grid(n, n, n, voxel_mm, -0.5 * (n - 1) * voxel_mm), {}};
  const auto& g = volume.grid;
  for (const auto [k, j, i] : indices(n, n, n)) {
    volume.values.push_back(
        static_cast<float>(10 + radius_mm - std::hypot(g.x_mm(i) - 0.3, g.y_mm(j) + 0.2, g.z_mm(k) - 0.1)));
  }
  return volume;
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

/// Of the trilinear field, by 6 x 6 x 6 points a cell.
double volume_above(const model::Volume& volume, double level) {
  constexpr int points = 6;
  const auto& g = volume.grid;
  const auto at = [&](int i, int j, int k) { return static_cast<double>(volume.slice(k)[j * g.nx + i]); };
  int above = 0;
  for (int k = 0; k + 1 < g.nz; ++k) {
    for (int j = 0; j + 1 < g.ny; ++j) {
      for (int i = 0; i + 1 < g.nx; ++i) {
        for (int p = 0; p < points * points * points; ++p) {
          const double x = (p % points + 0.5) / points;
          const double y = (p / points % points + 0.5) / points;
          const double z = (p / (points * points) + 0.5) / points;
          double value = 0;
          for (int c = 0; c < 8; ++c)
            value += ((c & 1) != 0 ? x : 1 - x) * ((c & 2) != 0 ? y : 1 - y) * ((c & 4) != 0 ? z : 1 - z) *
                     at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
          above += value >= level ? 1 : 0;
        }
      }
    }
  }
  return above * std::pow(g.voxel_mm / points, 3);
}

/// Three rods of that radius, in voxels, that do not lie along the axes: 5 voxels apart.
model::Volume rods(double radius) {
  constexpr int n = 28;
  model::Volume volume{model::centred_grid(n, n, n, 1, -0.5 * (n - 1)), {}};
  const auto& g = volume.grid;
  for (const auto [k, j, i] : indices(n, n, n)) {
    const double u = 0.36 * g.x_mm(i) + 0.48 * g.y_mm(j) + 0.8 * g.z_mm(k);
    const double v = 0.8 * g.x_mm(i) - 0.6 * g.y_mm(j);
    const double along = 0.48 * g.x_mm(i) + 0.64 * g.y_mm(j) - 0.6 * g.z_mm(k);
    const double to_rod = std::hypot(u - 5 * std::clamp(std::round(u / 5), -1.0, 1.0), v - 0.3);
    volume.values.push_back(static_cast<float>(10 + radius - std::max(to_rod, std::abs(along) - 9)));
  }
  return volume;
}

}  // namespace

TEST_CASE("a ball: closed, outward, its volume, its vertices on the sphere") {
  const double radius = 4;
  const auto mesh = solid::isosurface(ball(radius, 0.25, 48), 10);
  CHECK(closed(mesh));
  CHECK(oracle::signed_volume(mesh) ==
        doctest::Approx(4.0 / 3 * std::numbers::pi * radius * radius * radius).epsilon(0.005));
  for (const auto& p : mesh.points)
    CHECK(std::abs(std::hypot(p[0] - 0.3, p[1] + 0.2, p[2] - 0.1) - radius) <
          0.1 * 0.25);  // dual vertices lie inside their cell; a tenth of a voxel at this curvature
}

TEST_CASE("a surface closes at the grid's border") {
  const auto mesh = solid::isosurface(ball(8, 0.25, 48), 10);  // reaches beyond the 12 mm cube in the corners only
  CHECK(closed(mesh));
  CHECK(oracle::signed_volume(mesh) > 0);
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

TEST_CASE("of rods of two voxels the fine surface has the volume of the trilinear field, the coarse one less") {
  for (const double radius : {0.8, 1.0, 1.3}) {
    CAPTURE(radius);
    const model::Volume volume = rods(radius);
    const double wanted = volume_above(volume, 10);
    const auto fine = solid::fine_isosurface(volume, 10);
    CHECK(closed(fine));
    CHECK(oracle::signed_volume(fine) == doctest::Approx(wanted).epsilon(0.1));  // chords of a circle of 3 voxels
    CHECK(oracle::signed_volume(solid::isosurface(volume, 10)) < 0.9 * wanted);
  }
}

TEST_CASE("the fine surface of half as many voxels lies nearer to a ball, and many triangles stay as they are") {
  const auto worst = [](const model::TriangleSoup& mesh) {
    double most = 0;
    for (const auto& p : mesh.points)
      most = std::max(most, std::abs(std::hypot(p[0] - 0.3, p[1] + 0.2, p[2] - 0.1) - 3));
    return most;
  };
  const model::Volume volume = ball(3, 0.25, 40);
  const auto coarse = solid::isosurface(volume, 10);
  const auto fine = solid::fine_isosurface(volume, 10);
  CHECK(closed(fine));
  CHECK(fine.triangles.size() > 3 * coarse.triangles.size());
  CHECK(worst(fine) < 0.02);
  CHECK(worst(fine) < worst(coarse) + 0.001);
  const model::Volume large = ball(3, 0.025, 290);
  CHECK(solid::fine_isosurface(large, 10).triangles.size() == solid::isosurface(large, 10).triangles.size());
}
