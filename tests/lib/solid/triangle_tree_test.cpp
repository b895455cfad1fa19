// SPDX-License-Identifier: GPL-3.0-or-later
// The tree against CGAL's, and heights from above against closed forms.
#include "solid/mesh/private/triangle_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "lib/meshes.hpp"
#include "solid/mesh/height_map.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

namespace {

/// CGAL's tree of the same triangles.
struct Judge {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;

  explicit Judge(const std::vector<TriangleCorners>& soup) {
    for (const TriangleCorners& t : soup) triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
    tree.insert(triangles.cbegin(), triangles.cend());
    tree.build();
  }
  static Kernel::Point_3 point(const Vector3& p) { return {p[0], p[1], p[2]}; }

  Triangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

/// Vectors with coordinates between -size and size.
class AnyVector {
 public:
  explicit AnyVector(unsigned seed) : random_(seed) {}
  Vector3 operator()(double size) { return {size * unit_(random_), size * unit_(random_), size * unit_(random_)}; }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> unit_{-1, 1};
};

}  // namespace

TEST_CASE("nearest points are those of CGAL's AABB tree, from any start") {
  AnyVector any(1);
  std::vector<TriangleCorners> soup;  // long, short, needles, crossing each other
  for (int i = 0; i < 2000; ++i) {
    const Vector3 a = any(5);
    const Vector3 b = a + any(i % 3 == 0 ? 2 : 0.1);
    soup.push_back({a, b, i % 7 == 0 ? b + any(1e-5) : a + any(0.3)});
  }
  const Judge judge(soup);
  const TriangleTree tree(soup);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = any(i % 2 == 0 ? 5 : 20);
    const double wanted = std::sqrt(judge.tree.squared_distance(Judge::point(p)));
    const Nearest found = tree.nearest(p, i);
    CHECK(std::sqrt(found.distance2) == doctest::Approx(wanted).epsilon(1e-9));
    CHECK(length(p - found.point) == doctest::Approx(wanted).epsilon(1e-9));
    const Vector3 on = nearest_on(tree.triangles[found.triangle], p);
    CHECK(length(on - found.point) == 0);
  }
}

TEST_CASE("the first triangle that a short ray meets is that of CGAL's AABB tree, of all or of every other one") {
  AnyVector any(3);
  std::vector<TriangleCorners> soup;
  for (int i = 0; i < 1500; ++i) {
    const Vector3 a = any(3);
    soup.push_back({a, a + any(0.7), a + any(0.7)});
  }
  const Judge judge(soup);
  const TriangleTree tree(soup);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const bool every_other = i % 2 == 0;
    const Vector3 from = any(3);
    Vector3 along = any(1);
    along = (1 / length(along)) * along;
    constexpr double reach = 1.5;
    const Judge::Kernel::Segment_3 way(Judge::point(from), Judge::point(from + reach * along));
    std::vector<Judge::Primitive::Id> crossed;
    judge.tree.all_intersected_primitives(way, std::back_inserter(crossed));
    double nearest = 2 * reach;
    for (const auto& id : crossed) {
      if (every_other && (id - judge.triangles.cbegin()) % 2 != 0) continue;
      const auto plane = id->supporting_plane();
      const auto normal = plane.orthogonal_vector();
      nearest = std::min(nearest, normal * (plane.point() - way.source()) / (normal * way.to_vector()) * reach);
    }
    const auto counts = [&](int triangle) { return tree.order[triangle] % 2 == 0; };
    const auto hit =
        every_other ? tree.first_hit(from, along, 0, reach, counts) : tree.first_hit(from, along, 0, reach);
    CHECK(hit.has_value() == (nearest < 2 * reach));
    if (!hit) continue;
    ++met;
    CHECK(hit->distance == doctest::Approx(nearest).epsilon(1e-9));
  }
  CHECK(met > 1000);
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
  for (const auto [j, i] : indices(ball.heights_mm.height, ball.heights_mm.width)) {
    const double r2 = std::pow(ball.x_mm + 0.25 * i - 1, 2) + std::pow(ball.y_mm - 0.25 * j - 2, 2);
    if (r2 < 20) CHECK(ball.heights_mm(i, j) == doctest::Approx(3 + std::sqrt(25 - r2)).epsilon(1e-3));
    if (r2 > 25) CHECK(std::isnan(ball.heights_mm(i, j)));
  }
}

TEST_CASE("a cube meets the triangles that CGAL's AABB tree has it meet") {
  AnyVector any(5);
  std::vector<TriangleCorners> soup;
  for (int i = 0; i < 400; ++i) {
    const Vector3 a = any(5);
    soup.push_back({a, a + any(i % 5 == 0 ? 3 : 0.3), a + any(0.5)});
  }
  const Judge judge(soup);
  const TriangleTree tree(soup);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3 centre = any(5);
    const double half = i % 2 == 0 ? 0.2 : 0.6;
    const Vector3 to{half, half, half};
    const Judge::Kernel::Iso_cuboid_3 cube(Judge::point(centre - to), Judge::point(centre + to));
    const bool wanted = judge.tree.do_intersect(cube);
    CHECK(tree.meets_cube(centre, half) == wanted);
    met += wanted ? 1 : 0;
  }
  CHECK(met > 300);
  CHECK(met < 2700);
}
