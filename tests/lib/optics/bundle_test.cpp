// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "optics/chief_ray.hpp"
#include "oracle/lens_dose.hpp"

using namespace vam::optics;

namespace {

struct Line {
  double offset, delta, height, climb;  // at the point nearest to the axis
};

Line line_of(const vam::oracle::ResinRay& ray) {
  const double level = std::hypot(ray.along.x, ray.along.y);
  const double x = ray.along.x / level, y = ray.along.y / level, climb = ray.along.z / level;
  const double u = ray.at.x * x + ray.at.y * y;
  return {ray.at.x * y - ray.at.y * x, std::atan2(-x, y), ray.at.z - u * climb, climb};
}

void compare(const View& view, double focus_mm) {
  vam::oracle::LensBench bench;
  bench.radius = view.shells.front().radius_mm;
  bench.wall = bench.radius - view.shells.back().radius_mm;
  bench.glass = view.shells.front().index;
  bench.resin = view.shells.back().index;
  bench.bath = view.bath_index;
  bench.window = view.bath_index == 1 ? 0 : view.window_mm;
  bench.column_throw = view.lens_mm.value_or(0);
  bench.focus = focus_mm;
  constexpr double small = 1e-4;
  for (const double x_p : {-9.5, 0.0, 3.0, 11.0}) {
    const double slope = view.lens_mm ? x_p / *view.lens_mm : 0;
    const double across = small * (1 + slope * slope);  // of the tangents, by the angle
    const Line right = line_of(trace_in(bench, x_p, 0, {across, 0}));
    const Line left = line_of(trace_in(bench, x_p, 0, {-across, 0}));
    const Line above = line_of(trace_in(bench, x_p, 0, {0, small * std::sqrt(1 + slope * slope)}));
    const Bundle rays = bundle(view, x_p, focus_mm);
    REQUIRE(rays.hits);
    CHECK(std::abs((right.offset - left.offset) / (2 * small) - rays.offset_rate_mm) < 1e-5);
    CHECK(std::abs((right.delta - left.delta) / (2 * small) - rays.delta_rate) < 1e-6);
    CHECK(std::abs(above.height / small - rays.height_rate_mm) < 1e-5);
    CHECK(std::abs(above.climb / small - rays.climb_rate) < 1e-6);
  }
}

}  // namespace

TEST_CASE("a bundle is that of rays through the image point, traced by vector Snell") {
  compare({std::nullopt, 1, 0, {{12.7, 1.53}}}, 0);
  compare({60, 1, 0, {{12.7, 1.47}, {11.5, 1.51}}}, 0);
  compare({120, 1, 0, {{12.7, 1.53}}}, 3);
  compare({80, 1.4, 20, {{12.7, 1.47}, {11.5, 1.51}}}, -2);
}

TEST_CASE("parallel light that aims at the axis keeps its angle in a round vial, and has another focus along z") {
  const View vial{std::nullopt, 1, 0, {{12.7, 1.5}}};
  for (const double t : {0.0, 3.0, 8.0}) {
    const Bundle rays = bundle(vial, 1.5 * t, 0);
    CHECK(rays.delta_rate == doctest::Approx(-1));
    CHECK(std::abs(rays.offset_rate_mm) < 1e-6);
    const double focus = 1.5 * std::sqrt(12.7 * 12.7 - 2.25 * t * t) - std::sqrt(12.7 * 12.7 - t * t);
    CHECK(-rays.height_rate_mm / rays.climb_rate == doctest::Approx(focus).epsilon(1e-4));
    CHECK(rays.climb_rate == doctest::Approx(1 / 1.5));
  }
  CHECK(bundle({std::nullopt, 1.5, 20, {{12.7, 1.5}}}, 3, 0).delta_rate == doctest::Approx(-1 / 1.5));
  CHECK_FALSE(bundle(vial, 13, 0).hits);
}
