// SPDX-License-Identifier: GPL-3.0-or-later
// The tree against CGAL's, and heights from above against closed forms.
#include "solid/mesh/private/triangle_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <doctest/doctest.h>

#include <random>

#include "lib/meshes.hpp"
#include "solid/mesh/height_map.hpp"

using namespace vam;
using namespace vam::solid;

TEST_CASE("nearest points are those of CGAL's AABB tree, from any start") {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto any = [&](double size) { return Vector3{size * unit(random), size * unit(random), size * unit(random)}; };
  std::vector<TriangleCorners> soup;  // long, short, needles, crossing each other
  for (int i = 0; i < 2000; ++i) {
    const Vector3 a = any(5);
    const Vector3 b = a + any(i % 3 == 0 ? 2 : 0.1);
    soup.push_back({a, b, i % 7 == 0 ? b + any(1e-5) : a + any(0.3)});
  }
  Triangles judges;
  const auto to_cgal = [](const Vector3& p) { return Kernel::Point_3(p[0], p[1], p[2]); };
  for (const TriangleCorners& t : soup) judges.emplace_back(to_cgal(t[0]), to_cgal(t[1]), to_cgal(t[2]));
  const CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> judge(judges.cbegin(), judges.cend());
  const TriangleTree tree(soup);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = any(i % 2 == 0 ? 5 : 20);
    const double wanted = std::sqrt(judge.squared_distance(to_cgal(p)));
    const Nearest found = tree.nearest(p, i);
    CHECK(std::sqrt(found.distance2) == doctest::Approx(wanted).epsilon(1e-9));
    CHECK(length(p - found.point) == doctest::Approx(wanted).epsilon(1e-9));
    const Vector3 on = nearest_on(tree.triangles[found.triangle], p);
    CHECK(length(on - found.point) == 0);
  }
}

TEST_CASE("heights from above: a box on a box, and a ball") {
  model::TriangleSoup mesh;
  test::add_box({-2, -1, 0}, {2, 1, 1}, mesh);
  test::add_box({0, -0.5, 1}, {1, 0.5, 1.5}, mesh);
  const HeightMap map = height_map(mesh, 0.1);
  const auto at = [&](double x, double y) {
    return map.heights_mm(static_cast<int>(std::lround((x - map.x_mm) / 0.1)),
                          static_cast<int>(std::lround((map.y_mm - y) / 0.1)));
  };
  CHECK(at(0.5, 0.3) == doctest::Approx(1.5));
  CHECK(at(-0.5, 0.3) == doctest::Approx(1));
  CHECK(at(0.5, 0.8) == doctest::Approx(1));
  CHECK(std::isnan(map.heights_mm(0, 0)));

  const HeightMap ball = height_map(test::sphere({1, 2, 3}, 5, 200), 0.25);
  for (int j = 0; j < ball.heights_mm.height; ++j) {
    for (int i = 0; i < ball.heights_mm.width; ++i) {
      const double r2 = std::pow(ball.x_mm + 0.25 * i - 1, 2) + std::pow(ball.y_mm - 0.25 * j - 2, 2);
      if (r2 < 20) CHECK(ball.heights_mm(i, j) == doctest::Approx(3 + std::sqrt(25 - r2)).epsilon(1e-3));
      if (r2 > 25) CHECK(std::isnan(ball.heights_mm(i, j)));
    }
  }
}
