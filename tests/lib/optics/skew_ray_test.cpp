// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/skew_ray.hpp"

#include "oracle/ray_tracer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optics;

namespace {

struct Case {
  View view;
  vam::oracle::Bench bench;
};

Case bench(double lens_mm, double bath, double window_mm, std::vector<Shell> shells) {
  Case c{{lens_mm, bath, window_mm, shells, lens_mm}, {}};
  c.bench.lens_distance = lens_mm;
  c.bench.bath = bath;
  c.bench.window = bath == 1 ? 0 : window_mm;
  for (const Shell& shell : shells) c.bench.cylinders.push_back({shell.radius_mm, shell.index});
  return c;
}

const Case cases[] = {bench(119.808, 1, 0, {{12.7, 1.53}}), bench(60, 1, 0, {{12.7, 1.47}, {11.5, 1.51}}),
                      bench(92, 1.4, 20, {{12.7, 1.47}, {11.5, 1.53}})};

}  // namespace

TEST_CASE("a skew ray is that of Snell's law in vector form") {
  for (const Case& c : cases) {
    for (const double z_p : {-25.0, -7.0, 0.0, 0.4, 12.0, 25.0}) {
      for (const double x_p : {-9.0, -2.5, 0.0, 0.01, 6.0, 10.5}) {
        const SkewRay ray = skew_ray(c.view, x_p, z_p);
        const auto want = vam::oracle::trace(c.bench, x_p, z_p);
        REQUIRE(ray.hits == want.has_value());
        if (!want) continue;
        const auto line = vam::oracle::line_of(*want);
        const auto level = std::hypot(want->direction[0], want->direction[1]);
        const auto climb = want->direction[2] / level;
        const auto u = -want->point[0] * std::sin(line.a) + want->point[1] * std::cos(line.a);
        CHECK(std::abs(ray.offset_mm - static_cast<double>(line.t)) < 1e-9);
        CHECK(std::abs(ray.delta_rad - static_cast<double>(line.a)) < 1e-9);
        CHECK(std::abs(ray.climb - static_cast<double>(climb)) < 1e-9);
        CHECK(std::abs(ray.height_mm - static_cast<double>(want->point[2] - climb * u)) < 1e-9);
        CHECK(std::abs(ray.transmittance - static_cast<double>(want->transmittance)) < 1e-9);
      }
    }
  }
}

TEST_CASE("rays through a vial that stands off the axis are those of vector Snell") {
  const Displacement off{0.8, -0.5};
  for (const Case& c : cases) {
    vam::oracle::Bench moved = c.bench;
    moved.axis_x = 0.8L;
    moved.axis_y = -0.5L;
    for (const double x_p : {-6.0, 0.3, 7.0}) {
      for (const double z_p : {-20.0, 0.0, 11.0}) {
        const auto want = vam::oracle::trace(moved, x_p, z_p);
        const SkewRay ray = skew_ray(c.view, x_p, z_p, off);
        REQUIRE(ray.hits == want.has_value());
        auto seen = *want;  // from the vial's axis
        seen.point[0] -= 0.8L;
        seen.point[1] += 0.5L;
        const auto line = vam::oracle::line_of(seen);
        const auto climb = seen.direction[2] / std::hypot(seen.direction[0], seen.direction[1]);
        const auto u = -seen.point[0] * std::sin(line.a) + seen.point[1] * std::cos(line.a);
        CHECK(std::abs(ray.offset_mm - static_cast<double>(line.t)) < 1e-9);
        CHECK(std::abs(ray.delta_rad - static_cast<double>(line.a)) < 1e-9);
        CHECK(std::abs(ray.height_mm - static_cast<double>(seen.point[2] - climb * u)) < 1e-9);
        CHECK(std::abs(ray.transmittance - static_cast<double>(want->transmittance)) < 1e-9);
      }
    }
  }
}

TEST_CASE("a level ray is a chief ray") {
  for (const Case& c : cases) {
    for (const double x_p : {-9.0, 0.0, 4.0}) {
      const SkewRay ray = skew_ray(c.view, x_p, 0);
      const ChiefRay flat = chief_ray(c.view, x_p);
      CHECK(std::abs(ray.offset_mm - flat.x_v_mm) < 1e-12);
      CHECK(std::abs(ray.delta_rad - flat.delta_rad) < 1e-12);
      CHECK(std::abs(ray.transmittance - flat.transmittance) < 1e-12);
      CHECK(ray.climb == 0);
    }
  }
}

TEST_CASE("the ray through a point passes through it, and its density is that of its neighbours") {
  for (const Case& c : cases) {
    const RayAt at = ray_through(c.view, 3.1, -4.2, 11.0, 4, 11);
    REQUIRE(at.ray.hits);
    const double d = at.ray.delta_rad;
    CHECK(std::abs(3.1 * std::cos(d) - 4.2 * std::sin(d) - at.ray.offset_mm) < 1e-9);
    CHECK(std::abs(at.ray.z_mm(-4.2 * std::cos(d) - 3.1 * std::sin(d)) - 11.0) < 1e-9);
    // The area of a small square of the image plane, where its rays cross the plane through the point: vectors.
    const auto crossing = [&](double x_p, double z_p) {
      const auto ray = *vam::oracle::trace(c.bench, x_p, z_p);
      const auto centre = *vam::oracle::trace(c.bench, at.x_p_mm, at.z_p_mm);
      const auto& n = centre.direction;
      const auto gap = n[0] * (3.1L - ray.point[0]) + n[1] * (-4.2L - ray.point[1]) + n[2] * (11.0L - ray.point[2]);
      const auto along = gap / (n[0] * ray.direction[0] + n[1] * ray.direction[1] + n[2] * ray.direction[2]);
      return vam::oracle::Vec{ray.point[0] + along * ray.direction[0], ray.point[1] + along * ray.direction[1],
                              ray.point[2] + along * ray.direction[2]};
    };
    const double h = 1e-3;
    const auto right = crossing(at.x_p_mm + h, at.z_p_mm);
    const auto left = crossing(at.x_p_mm - h, at.z_p_mm);
    const auto above = crossing(at.x_p_mm, at.z_p_mm + h);
    const auto below = crossing(at.x_p_mm, at.z_p_mm - h);
    vam::oracle::Vec a{};
    vam::oracle::Vec b{};
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = (right[k] - left[k]) / (2 * h);
      b[k] = (above[k] - below[k]) / (2 * h);
    }
    const auto area = std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    CHECK(at.density * static_cast<double>(area) == doctest::Approx(1).epsilon(1e-6));
  }
}
