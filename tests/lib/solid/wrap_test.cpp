// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces around meshes of any state: they are closed, and lie between the mesh and its offset.
#include "solid/wrap/wrap.hpp"

#include "lib/meshes.hpp"
#include "oracle/meshes.hpp"
#include "solid/mesh/repair.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;
using model::TriangleSoup;

namespace {

constexpr double radius_mm = 5;

/// With so many holes of some 0.4 mm, and the rest turned at random.
TriangleSoup punched_sphere(int holes) {
  TriangleSoup mesh = test::sphere({0, 0, 0}, radius_mm, 100);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  for (int hole = 0; hole < holes; ++hole) {
    const Vector3 way{normal(random), normal(random), normal(random)};
    const Vector3 at = (radius_mm / length(way)) * way;
    std::erase_if(mesh.triangles, [&](const auto& t) { return length(mesh.points[t[0]] - at) < 0.2; });
  }
  for (auto& t : mesh.triangles)
    if (random() % 2 == 0) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace

TEST_CASE("a sphere with 100 holes is wrapped into a closed one, larger by no more than the offset") {
  const WrapSize size{0.3, 0.02};
  TriangleSoup open = punched_sphere(100);
  const Wrap wrap = wrapped(open, size, "sphere");
  CHECK(wrap.open_edges > 1000);
  TriangleSoup mesh = wrap.mesh;
  const Repair done = repair(mesh, "wrap");
  CHECK(done.closed());
  CHECK_FALSE(done.changed());
  CHECK(done.components == 1);
  CHECK(done.cavities == 0);
  for (const Vector3& p : mesh.points) {
    CHECK(length(p) <= radius_mm + size.offset_mm + 1e-9);
    CHECK(length(p) >= radius_mm - 0.02);  // lids of the largest holes lie 0.25^2 / (2 * 5) mm within
  }
  const double ball_mm3 = 4.0 / 3 * std::numbers::pi * std::pow(radius_mm, 3);
  const double shell_mm3 = 4 * std::numbers::pi * radius_mm * radius_mm * size.offset_mm;
  CHECK(std::abs(oracle::signed_volume(mesh) - ball_mm3) < shell_mm3);
}

TEST_CASE("what is crossed, doubled or within does not matter, and grooves wider than alpha stay") {
  TriangleSoup mesh;
  test::add_box({0, 0, 0}, {4, 4, 1}, mesh);
  test::add_box({0, 0, 0.5}, {1, 4, 4}, mesh);  // crosses the first
  test::add_box({3, 0, 0.5}, {4, 4, 4}, mesh);
  test::add_box({3.4, 1, 1}, {3.6, 2, 2}, mesh);  // within
  mesh.triangles.resize(mesh.triangles.size() - 1);
  mesh.triangles.push_back(mesh.triangles.front());
  const WrapSize size{0.2, 0.02};
  const double volume_mm3 = oracle::signed_volume(wrapped(mesh, size, "groove").mesh);
  CHECK(volume_mm3 > 40);
  CHECK(volume_mm3 < 40 + 108 * size.offset_mm + 0.5);  // inner edges are rounded
}

TEST_CASE("a band that is missing around a tube is closed along it, and the tube's hole stays open") {
  const WrapSize size{0.3, 0.02};
  TriangleSoup mesh;
  constexpr int around = 60;
  const auto ring = [&](double r, double z) {
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * std::numbers::pi * i / around;
      mesh.points.push_back({r * std::cos(turn), r * std::sin(turn), z});
    }
  };
  const std::vector<std::array<double, 2>> profile{{2, 0}, {4, 0}, {4, 1.4}, {4, 1.6}, {4, 3}, {2, 3}, {2, 0}};
  for (const auto& [r, z] : profile) ring(r, z);
  for (const auto [side, i] : indices(6, around)) {
    if (side == 2) continue;  // the band
    const int next = (i + 1) % around;
    const int low = side * around;
    mesh.triangles.push_back({low + i, low + next, low + around + i});
    mesh.triangles.push_back({low + next, low + around + next, low + around + i});
  }
  const double tube_mm3 = 0.5 * around * std::sin(2 * std::numbers::pi / around) * (16 - 4) * 3;
  const double shell_mm3 = 2 * std::numbers::pi * (12 + 6 * 3) * size.offset_mm;
  CHECK(std::abs(oracle::signed_volume(wrapped(mesh, size, "tube").mesh) - tube_mm3) < shell_mm3);
}

TEST_CASE("a lid closes a hole flat") {
  TriangleSoup mesh = oracle::box({0, 0, 0}, {1, 2, 3});
  CHECK(close_holes(mesh) == 0);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  CHECK(close_holes(mesh) == 4);
  CHECK(repair(mesh, "box").closed());
  CHECK(oracle::signed_volume(mesh) == doctest::Approx(6));
}

TEST_CASE("a wrap of too many triangles is refused with the length that helps") {
  const TriangleSoup mesh = test::sphere({0, 0, 0}, radius_mm, 20);
  CHECK_THROWS_WITH_AS(
      (void)wrapped(mesh, {0.001, 0.001}, "sphere"),
      doctest::Contains("sphere: its wrap of 0.001 mm would have 656 million triangles; up to 2 million are"), Error);
}

TEST_CASE(
    "what is taken away from boxes leaves the volume that geometry gives, inside, across a face and through both") {
  const auto boxes = [](std::initializer_list<std::array<double, 6>> all) {
    vam::model::TriangleSoup mesh;
    for (const auto& [x0, y0, z0, x1, y1, z1] : all) {
      const int n = static_cast<int>(mesh.points.size());
      for (const double z : {z0, z1})
        for (const double y : {y0, y1})
          for (const double x : {x0, x1}) mesh.points.push_back({x, y, z});
      for (const auto& [a, b, c, d] :
           {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        mesh.triangles.push_back({n + a, n + b, n + c});
        mesh.triangles.push_back({n + a, n + c, n + d});
      }
    }
    return mesh;
  };
  const auto left = [&](const auto& mesh, const auto& cutter) {
    return oracle::signed_volume(vam::solid::difference(mesh, cutter, "part"));
  };
  const auto one = boxes({{0, 0, 0, 6, 6, 6}});
  CHECK(left(one, boxes({{2, 2, 2, 4, 4, 4}})) == doctest::Approx(208));
  CHECK(left(one, boxes({{2, 2, 4, 4, 4, 8}})) == doctest::Approx(208));                      // out of the top
  CHECK(left(one, boxes({{2, 2, 4, 4, 4, 6}, {2, 2, 3, 4, 4, 5}})) == doctest::Approx(204));  // flush with it, in two
  // Of boxes that overlap each loses its own, so that their sum is 2 x 216 less 2 x 12.
  const auto two = boxes({{0, 0, 0, 6, 6, 6}, {3, 1, 1, 9, 7, 7}});
  CHECK(left(two, boxes({{4, 2, 2, 5, 5, 6}})) == doctest::Approx(408));
  auto open = one;
  open.triangles.pop_back();
  CHECK(has(error_of([&] { (void)left(open, one); }, vam::Fault::data), "one of them is not closed"));
  CHECK(has(error_of([&] { (void)left(one, one); }, vam::Fault::data), "nothing is left"));
}
