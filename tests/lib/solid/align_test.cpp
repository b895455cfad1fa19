// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 10 -tc=48 to 57 %*
#include "solid/mesh/align.hpp"

#include <utility>

#include "base/random.hpp"
#include "lib/meshes.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/private/triangle_tree.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "solid/mesh/surface_samples.hpp"
#include "solid/shapes/shapes.hpp"
#include "solid/voxel/isosurface.hpp"
#include "testing.hpp"
#include "trials.hpp"

using namespace vam;
using vam::model::TriangleSoup;

namespace {

// Three blocks of different sizes: no symmetry at all.
TriangleSoup blocks() {
  TriangleSoup mesh;
  test::add_box({0, 0, 0}, {10, 4, 3}, mesh);
  test::add_box({0, 4.5, 0}, {3, 9, 6}, mesh);
  test::add_box({7, -3, 4}, {9, 3, 5}, mesh);
  return mesh;
}

// Body, head, two unlike ears and a tail: rounded, with principal axes that say little, like a scanned animal.
TriangleSoup animal() {
  TriangleSoup mesh;
  const auto add = [&](const Vector3& centre, const Vector3& size) {
    TriangleSoup ball = test::sphere({0, 0, 0}, 1, 24);
    const int first = static_cast<int>(mesh.points.size());
    for (const auto& p : ball.points)
      mesh.points.push_back({centre[0] + size[0] * p[0], centre[1] + size[1] * p[1], centre[2] + size[2] * p[2]});
    for (const auto& t : ball.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  };
  add({0, 0, 0}, {4, 5, 4.5});
  add({0.5, -4, 4}, {2.4, 2.8, 2.5});
  add({1.5, -3.5, 7.5}, {0.6, 0.9, 2.4});
  add({-0.8, -2.6, 7}, {0.6, 1.2, 2});
  add({0, 5, -2.5}, {1.2, 1.2, 1.2});
  return mesh;
}

TriangleSoup gyroid() {
  const solid::Field field = solid::make_shape("gyroid:cell=5,sheet=1,diameter=10,height=7.5");
  const model::Grid grid = model::centred_grid(46, 46, 36, 0.25, -0.25 * 17.5);
  model::Volume volume{grid, std::vector<float>(grid.size())};
  solid::cover(field, grid, 0, grid.nz, volume.values.data());
  return solid::isosurface(volume, 0.5);
}

TriangleSoup moved(TriangleSoup mesh, const solid::Similarity& motion) {
  for (auto& p : mesh.points) p = motion(p);
  return mesh;
}

solid::Similarity turn(const Vector3& axis, double degrees, const Vector3& shift, double scale = 1) {
  const double a = degrees * std::numbers::pi / 180;
  const Vector3 u = (1 / length(axis)) * axis;
  solid::Similarity s{.scale = scale, .shift_mm = shift};
  for (std::size_t r = 0; r < 3; ++r) {
    Vector3 unit{};
    unit[r] = 1;
    const Vector3 row = std::cos(a) * unit + (1 - std::cos(a)) * u[r] * u + std::sin(a) * cross(unit, u);
    s.rotation[r] = row;  // Rodrigues: row r of cos I + (1 - cos) u u^T + sin [u]x
  }
  return s;
}

// What is left of the solid below a plane through it, closed by the cut: 48 to 57 % of the volume, as it prints: at
// voxels, rough by `rough_mm`.
TriangleSoup part_of(const solid::Field& field, const model::Grid& grid, const Vector3& normal, double share,
                     double rough_mm, std::uint64_t seed) {
  model::Volume volume{grid, std::vector<float>(grid.size())};
  solid::cover(field, grid, 0, grid.nz, volume.values.data());
  std::vector<std::pair<double, std::size_t>> along;
  double total = 0;
  for (std::size_t i = 0; i < volume.values.size(); ++i) {
    if (volume.values[i] == 0) continue;
    const auto n = static_cast<int>(i);
    const Vector3 p{grid.x_mm(n % grid.nx), grid.y_mm(n / grid.nx % grid.ny), grid.z_mm(n / grid.nx / grid.ny)};
    along.emplace_back(dot(p, normal), i);
    total += static_cast<double>(volume.values[i]);
  }
  std::sort(along.begin(), along.end());
  double kept = 0;
  for (const auto& [height, i] : along) {
    if (kept > share * total) volume.values[i] = 0;
    kept += static_cast<double>(volume.values[i]);
  }
  TriangleSoup mesh = solid::isosurface(volume, 0.5);
  for (auto& p : mesh.points) {
    for (double& v : p) v += 2 * rough_mm * (unit_interval(seed = scrambled(seed)) - 0.5);
  }
  return mesh;
}

struct Design {
  solid::Field field;
  model::Grid grid;
  TriangleSoup mesh;
};

Design design_of(const char* shape, const std::array<int, 3>& voxels, double voxel_mm) {
  Design design{solid::make_shape(shape),
                model::centred_grid(voxels[0], voxels[1], voxels[2], voxel_mm, -0.5 * voxel_mm * (voxels[2] - 1)),
                {}};
  model::Volume volume{design.grid, std::vector<float>(design.grid.size())};
  solid::cover(design.field, design.grid, 0, design.grid.nz, volume.values.data());
  design.mesh = solid::isosurface(volume, 0.5);
  return design;
}

// Worst distance of the print's points from where they belong, back by the inverse of their turn.
double misplaced_mm(const TriangleSoup& right, const TriangleSoup& print, const solid::Similarity& found) {
  double worst = 0;
  for (std::size_t i = 0; i < print.points.size(); ++i)
    worst = std::max(worst, length(found(print.points[i]) - right.points[i]));
  return worst;
}

// A plate of 12 x 6 mm with two equal bores, up to this height, as voxels show it.
TriangleSoup bored_plate(double top_mm) {
  const model::Grid grid = model::centred_grid(64, 34, 14, 0.2, -1.3);
  model::Volume volume{grid, std::vector<float>(grid.size())};
  for (std::size_t i = 0; i < volume.values.size(); ++i) {
    const auto n = static_cast<int>(i);
    const double x = grid.x_mm(n % grid.nx);
    const double y = grid.y_mm(n / grid.nx % grid.ny);
    const double z = grid.z_mm(n / grid.nx / grid.ny);
    const double inside_mm =
        std::min({6 - std::abs(x), 3 - std::abs(y), z + 1, top_mm - z, std::hypot(std::abs(x) - 4, y) - 1});
    volume.values[i] = static_cast<float>(std::clamp(0.5 + inside_mm / grid.voxel_mm, 0.0, 1.0));
  }
  return solid::isosurface(volume, 0.5);
}

}  // namespace

TEST_CASE("winding number of a sphere, closed and with a hole") {
  TriangleSoup mesh = test::sphere({1, 2, 3}, 5, 60);
  const solid::WindingNumber whole(mesh);
  for (double x = -8; x <= 10; x += 0.7) {
    const double r = std::abs(x - 1);
    if (std::abs(r - 5) < 0.05) continue;  // on the surface it is undefined
    CHECK(whole({x, 2, 3}) == doctest::Approx(r < 5 ? 1.0 : 0.0).epsilon(0.05).scale(1));
  }
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 400);  // the polar cap
  const solid::WindingNumber open(mesh);
  CHECK(open({1, 2, 3}) > 0.5);
  CHECK(open({1, 2, -1}) > 0.5);
  CHECK(open({1, 2, 9}) < 0.5);
  CHECK(open({8, 2, 3}) < 0.5);
}

TEST_CASE("signed distances to a sphere are |x| - r, positive outside") {
  const solid::Surface surface(test::sphere({0, 0, 0}, 5, 200));
  // The facets of 200 rings lie up to r (pi/200)^2 / 8 x 2 = 3e-4 inside the sphere.
  for (const double r : {0.5, 2.0, 4.9, 5.1, 9.0}) {
    CHECK(surface.signed_distance({0.6 * r, 0, 0.8 * r}) == doctest::Approx(r - 5).epsilon(4e-4).scale(1));
  }
}

TEST_CASE("samples spread evenly over the area") {
  TriangleSoup mesh;  // a fine half and a coarse half of a rectangle 2 x 1
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  constexpr int n = 20;
  for (int i = 0; i < n; ++i) {
    const int first = static_cast<int>(mesh.points.size());
    const double x = 1 + static_cast<double>(i) / n;
    for (const auto& [dx, y] : {std::pair{0.0, 0.0}, {1.0 / n, 0.0}, {1.0 / n, 1.0}, {0.0, 1.0}})
      mesh.points.push_back({x + dx, y, 0});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  double sum = 0;
  const auto samples = solid::sample_surface(mesh, 10000);
  for (const auto& sample : samples) sum += sample.point[0];
  CHECK(samples.size() == 10000);
  CHECK(sum / 10000 == doctest::Approx(1.0).epsilon(0.005));
}

TEST_CASE("a pose scrambled by 170 degrees about any axis is found again") {
  const TriangleSoup reference = blocks();
  const solid::Surface surface(reference);
  for (const Vector3& axis : {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {-1, 2, 0.5}}) {
    const TriangleSoup print = moved(reference, turn(axis, 170, {30, -12, 4}));
    const auto found = solid::align(print, reference, surface, {});
    CHECK(found.converged);
    for (std::size_t i = 0; i < print.points.size(); ++i) {
      CHECK(length(found.transform(print.points[i]) - reference.points[i]) <
            1e-4);  // 1e-5 of the size: the stopping tolerance, amplified by linear convergence
    }
  }
}

TEST_CASE("170 degrees about any axis are found again on a rounded animal, and on a gyroid up to its symmetries") {
  for (const bool symmetric : {false, true}) {
    const TriangleSoup reference = symmetric ? gyroid() : animal();
    const solid::Surface surface(reference);
    for (const Vector3& axis : {Vector3{1, 0, 0}, {0, 0, 1}, {-1, 2, 0.5}}) {
      const TriangleSoup print = moved(reference, turn(axis, 170, {30, -12, 4}));
      const auto found = solid::align(print, reference, surface, {});
      double worst = 0;
      for (std::size_t i = 0; i < print.points.size(); ++i) {
        const Vector3 back = found.transform(print.points[i]);
        worst = std::max(worst,
                         symmetric ? length(back - surface.closest(back).point) : length(back - reference.points[i]));
      }
      CHECK(worst < 0.01);  // a thousandth of the size
    }
  }
}

TEST_CASE("shrinkage is measured with the scale") {
  const TriangleSoup reference = blocks();
  const solid::Surface surface(reference);
  const TriangleSoup print = moved(reference, turn({1, 2, 3}, 40, {1, 2, 3}, 0.97));
  solid::AlignOptions options{.with_scale = true};
  CHECK(solid::align(print, reference, surface, options).transform.scale == doctest::Approx(1 / 0.97).epsilon(1e-4));
}

TEST_CASE("the influence of debris is bounded from 2.5 times the deviation on [HUB64]") {
  // A cube of 10 mm and a plate of 2.5 x 2.5 mm that floats 2 mm before its face x = 5: the share p of the points that
  // is the plate's pulls the cube by t along x, where both forces are in balance. Each force is the area times the
  // distance times the weight min(1, bound / distance).
  TriangleSoup cube;
  test::add_box({-5, -5, -5}, {5, 5, 5}, cube);
  TriangleSoup print = cube;
  for (const auto& [y, z] : {std::pair{-1.25, -1.25}, {1.25, -1.25}, {1.25, 1.25}, {-1.25, 1.25}})
    print.points.push_back({7, y, z});
  print.triangles.push_back({8, 9, 10});
  print.triangles.push_back({8, 10, 11});
  const double plate = 6.25 / 606.25;
  const double across = 200 / 606.25;  // both faces across x
  double t = 0;
  for (int step = 0; step < 100; ++step) {
    const double distance = 2 - t;
    const double bound = 2.5 * std::sqrt(plate * distance * distance + across * t * t);
    t = plate * std::min(distance, bound) / across;
  }
  const auto found = solid::refine(print, solid::Surface(cube), {});
  CHECK(-found.transform.shift_mm[0] == doctest::Approx(t).epsilon(0.015));
  CHECK(std::abs(found.transform.shift_mm[1]) < 0.01 * t);
}

TEST_CASE("48 to 57 % of a print lie where they belong, every time") {
  const Design boat = design_of("boat:length=10", {60, 60, 60}, 0.2);
  const solid::Surface surface(boat.mesh);
  REQUIRE(solid::bounding_box(boat.mesh).largest_side() > 8);
  const auto draws = static_cast<std::uint64_t>(trials_or(2));
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    CAPTURE(draw);
    std::uint64_t seed = scrambled(draw + 1);
    const auto next = [&] { return unit_interval(seed = scrambled(seed)); };
    Vector3 normal{next() - 0.5, next() - 0.5, next() - 0.5};
    normal = (1 / length(normal)) * normal;
    const TriangleSoup right = part_of(boat.field, boat.grid, normal,
                                       0.48 + 0.1 * static_cast<double>(draw) / static_cast<double>(draws), 0.05, draw);
    const Vector3 axis{next() - 0.5, next() - 0.5, next() - 0.5};
    const TriangleSoup print = moved(right, turn(axis, 360 * next(), {30, -12, 4}));
    const auto found = solid::align(print, boat.mesh, surface, {});
    const double off_mm = misplaced_mm(right, print, found.transform);
    MESSAGE("part ", draw, " off by ", off_mm, " mm, overlap ", found.overlap, ", rival ", found.rival.has_value());
    CHECK(off_mm < 0.05);  // a quarter of a voxel
    CHECK(!found.rival);
    CHECK(found.overlap < 0.75);
  }
}

TEST_CASE("half a bar lies anywhere along it: ambiguous; half a cube in any corner: the same by symmetry") {
  TriangleSoup bar;
  test::add_box({0, 0, 0}, {20, 4, 3}, bar);
  TriangleSoup half;
  test::add_box({2, 0, 0}, {12, 4, 3}, half);
  const auto along = solid::align(moved(half, turn({1, 2, 3}, 77, {5, 5, 5})), bar, solid::Surface(bar), {});
  REQUIRE(along.rival);
  CHECK(along.rival->apart_mm > 0.4);
  TriangleSoup cube;
  test::add_box({0, 0, 0}, {10, 10, 10}, cube);
  TriangleSoup slab;
  test::add_box({0, 0, 0}, {10, 10, 5}, slab);
  solid::AlignOptions options;
  options.samples = 66 * 300;  // whole steps between the points by which symmetries are found
  const auto corner = solid::align(moved(slab, turn({1, 2, 3}, 77, {5, 5, 5})), cube, solid::Surface(cube), options);
  CHECK(!corner.rival);
}

TEST_CASE("half a plate that fits either way up is refused however it was turned") {
  TriangleSoup plate = bored_plate(1);
  test::add_box({4.1, 0.8, 0.9}, {5.9, 2.6, 2.8}, plate);  // says which side is up
  const TriangleSoup lower = bored_plate(0.05);
  const solid::Surface surface(plate);
  std::uint64_t seed = 15;
  const auto next = [&] { return unit_interval(seed = scrambled(seed)) - 0.5; };
  for (int draw = 0; draw < trials_or(4); ++draw) {
    CAPTURE(draw);
    const Vector3 axis{next(), next(), next()};
    const auto found = solid::align(moved(lower, turn(axis, 360 * next(), {1, 2, 3})), plate, surface, {});
    REQUIRE(found.rival);
    CHECK(found.rival->match > 0.95 * found.rival->best_match);
  }
}
