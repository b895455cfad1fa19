// SPDX-License-Identifier: GPL-3.0-or-later
// Fields at many points at once.
#include "solid/shapes/shapes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

namespace {

// The gyroid's distance in radians, step by step with the sines of the library.
double slow_gyroid_distance(Point p, double near) {
  const auto level = [](const Point& q) {
    return std::sin(q[0]) * std::cos(q[1]) + std::sin(q[1]) * std::cos(q[2]) + std::sin(q[2]) * std::cos(q[0]);
  };
  const auto gradient = [](const Point& q) {
    return Point{std::cos(q[0]) * std::cos(q[1]) - std::sin(q[2]) * std::sin(q[0]),
                 std::cos(q[1]) * std::cos(q[2]) - std::sin(q[0]) * std::sin(q[1]),
                 std::cos(q[2]) * std::cos(q[0]) - std::sin(q[1]) * std::sin(q[2])};
  };
  const double bound = std::abs(level(p)) / std::sqrt(3.0);
  if (bound > near) return bound;
  Point step{};
  for (int newton = 0; newton < 4; ++newton) {
    const Point normal = gradient(p + step);
    step = ((dot(step, normal) - level(p + step)) / dot(normal, normal)) * normal;
  }
  return length(step);
}

}  // namespace

TEST_CASE("a gyroid's distances are those of slow sines, near the axis and a thousand cells away") {
  const double near = 1.25 / std::sqrt(3.0);  // of a sheet as thick as can be
  const double unit = 2 * std::numbers::pi / 0.5;
  const Field field = make_shape("gyroid:cell=0.5,sheet=0.1,diameter=1000,height=1000");
  std::mt19937 random(3);
  for (const double reach_mm : {1.0, 300.0}) {
    std::uniform_real_distribution<double> anywhere(-reach_mm, reach_mm);
    for (int n = 0; n < 3000; ++n) {
      const Point p{anywhere(random), anywhere(random), anywhere(random)};
      const double slow = slow_gyroid_distance(unit * p, std::min(near, 1.6 * unit * 0.05)) / unit - 0.05;
      // The series of Newton's steps err by 1e-6 radians, and by more where they go farther than one.
      if (std::abs(slow) < 0.05) CHECK(field.value(p) == doctest::Approx(slow).scale(1).epsilon(1e-6));
    }
  }
}

TEST_CASE("many values at once are those of one by one, in any number, also of a moved solid") {
  std::mt19937 random(4);
  for (const ShapeKind& kind : shape_kinds()) {
    CAPTURE(std::string{kind.name});
    const Field plain = make_shape(std::string{kind.name});
    for (const Field& field : {plain, transformed(plain, scaling({1, 1, 1.04}) * rotation({30, 0, 45}))}) {
      for (const int count : {1, 7, 128, 129, 300}) {
        std::vector<Point> points(count);
        for (Point& p : points) {
          for (std::size_t a = 0; a < 3; ++a) {
            p[a] = std::uniform_real_distribution<double>(field.box.low[a], field.box.high[a])(random);
          }
        }
        std::vector<double> values(count);
        values_at(field, points, values.data());
        for (int n = 0; n < count; ++n) CHECK(values[n] == field.value(points[n]));
      }
    }
  }
}
