// SPDX-License-Identifier: GPL-3.0-or-later
#include "lib/light/operator_checks.hpp"
#include "lib/light/vials.hpp"
#include "lib/optimize/parts.hpp"
#include "oracle/part_2d.hpp"
#include "oracle/ray_tracer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using parts::packed;
using parts::vial_setup;

TEST_CASE("around an insert in the vial A and A* are adjoint, also around a concave one in an absorbing resin") {
  VialSetup setup = vial_setup(64, 72);
  setup.absorption_per_mm = 0.07;
  setup.direction = -1;
  const Slab cross =
      packed(vam::oracle::draw(64,
                               [](double x, double y) {
                                 return (std::abs(x) < 12 && std::abs(y) < 3) || (std::abs(y) < 12 && std::abs(x) < 3);
                               }),
             64);
  const VialOperator light(setup, {&cross, 1});
  CHECK(parts::adjoint_error(light) < 1e-5);
}

TEST_CASE("an empty insert casts no shadow in the vial") {
  const VialSetup setup = vial_setup(48, 60);
  const Slab nothing(48, 48);
  const VialOperator plain(setup);
  const VialOperator around(setup, {&nothing, 1});
  const Slab g = parts::noise(plain.sinogram(), 3);
  const Slab a = parts::dose_of(plain, g);
  const Slab b = parts::dose_of(around, g);
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    CHECK(static_cast<double>(std::abs(a.values[i] - b.values[i])) <
          1e-4);  // sums of order 10 of the same terms in another order
  }
}

TEST_CASE("a ray traced by Snell's law is lit as far as the insert and dark behind it") {
  const int size = 128;
  const VialSetup setup = vial_setup(size, 36);
  vam::oracle::Bench bench{.lens_distance = 119.808L, .cylinders = {{12.7L, 1.53L}}};
  for (const auto& [column, row] : {std::pair{219, 0}, {160, 7}, {300, 20}}) {
    const auto ray = vam::oracle::trace(bench, setup.projector.x_mm(column));
    REQUIRE(ray);
    const auto line = vam::oracle::line_of(*ray);
    const double angle = static_cast<double>(line.a) + row * setup.turn.step_rad;
    const auto voxel = [&](double u) {
      const double t = static_cast<double>(line.t);
      const double x = t * std::cos(angle) - u * std::sin(angle);
      const double y = t * std::sin(angle) + u * std::cos(angle);
      return std::pair{static_cast<int>(std::lround((x - setup.grid.x_mm(0)) / setup.grid.voxel_mm)),
                       static_cast<int>(std::lround((y - setup.grid.y_mm(0)) / setup.grid.voxel_mm))};
    };
    Slab insert(size, size);
    for (int k = 0; k < 9; ++k) insert.at(voxel(0).first + k % 3 - 1, voxel(0).second + k / 3 - 1)[0] = 1;  // lane 0
    const VialOperator light(setup, {&insert, 1});
    Slab image(light.image().width, light.image().height);
    std::fill_n(image.at(column - 1, row), 3 * lanes, 1.0F);
    Slab g(light.sinogram().width, light.sinogram().height);
    light.collapse(image, g);
    const Slab dose = parts::dose_of(light, g);
    const auto at = [&](double u, int lane) { return dose.at(voxel(u).first, voxel(u).second)[lane]; };
    for (const double u : {-3.0, -1.5}) CHECK(at(u, 0) > 0.0F);
    for (const double u : {0.0, 1.5, 3.0}) CHECK(at(u, 0) == 0.0F);
    for (const double u : {-3.0, 0.0, 3.0}) CHECK(at(u, 1) > 0.0F);
  }
}

TEST_CASE("a closed ring leaves its inside dark, in the vial too") {
  const int size = 64;
  const Slab ring =
      packed(vam::oracle::draw(size, [](double x, double y) { return std::abs(std::hypot(x, y) - 12) < 2; }), size);
  const VialOperator light(vial_setup(size, 90), {&ring, 1});
  Slab g(light.sinogram().width, light.sinogram().height);
  std::fill(g.values.begin(), g.values.end(), 1.0F);
  const Slab dose = parts::dose_of(light, g);
  CHECK(*dose.at(32, 32) == 0.0F);
  CHECK(*dose.at(50, 32) > 0.0F);
}
