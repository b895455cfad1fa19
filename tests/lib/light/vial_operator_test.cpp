// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/vial_operator.hpp"

#include "lib/light/operator_checks.hpp"
#include "lib/light/vials.hpp"
#include "lib/optimize/parts.hpp"
#include "oracle/part_2d.hpp"
#include "oracle/ray_dose.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using parts::vial_setup;

namespace {

/// Smooth light without symmetry.
double shine(double x_p, double theta) { return 1.2 + std::sin(0.35 * x_p + 2 * theta) + 0.1 * std::cos(theta); }

/// A short lens below a tall vial: rays climb by as much as they ever will.
VialSetup climbing(int size, int slices, int angles) {
  VialSetup setup = vial_setup(size, angles);
  setup.view.lens_mm = setup.view.rows_lens_mm = 80;
  setup.grid.nz = slices;
  setup.grid.origin_mm[2] = 3;  // the lens's axis is below
  setup.z_scale = 0.96;
  return setup;
}

/// Two turns in which things circle and rise.
VialSetup posed(VialSetup setup, int frames, model::Moves moves) {
  setup.turn = {frames, 0.2, 4 * std::numbers::pi / frames};
  for (int k = 0; k < frames; ++k) {
    setup.poses.push_back({360.0 * k / frames, 0.8 * std::cos(0.9 * k), 0.8 * std::sin(0.9 * k), 0.21 * k - 4, moves});
  }
  return setup;
}

}  // namespace

TEST_CASE("in the vial A and A* are adjoint, with and without inserts, in either direction of rotation") {
  CHECK(parts::adjoint_error(VialOperator(vial_setup(64, 90))) < 1e-5);
  CHECK(parts::adjoint_error(VialOperator(vial_setup(37, 91, parts::walled_vial))) < 1e-5);
  VialSetup turned = vial_setup(50, 72);
  turned.direction = -1;
  turned.angle_offset_rad = 0.4;
  turned.absorption_per_mm = 0.07;
  turned.projector.axis_column = 211.3;
  CHECK(parts::adjoint_error(VialOperator(turned)) < 1e-5);
}

TEST_CASE("four slabs at once give the results of each alone") {
  const VialOperator light(vial_setup(40, 60));
  std::vector<Slab> g;
  for (unsigned s = 0; s < 7; ++s) g.push_back(parts::noise(light.sinogram(), s));
  auto together = slabs(7, 40, 40);
  light.adjoint(g, together);
  for (std::size_t s = 0; s < 7; ++s) {
    Slab alone(40, 40);
    light.adjoint({&g[s], 1}, {&alone, 1});
    CHECK(together[s].values == alone.values);
  }
  auto projected = slabs(7, light.sinogram().width, light.sinogram().height);
  light.forward(together, projected);
  Slab alone(light.sinogram().width, light.sinogram().height);
  light.forward({&together[6], 1}, {&alone, 1});
  CHECK(projected[6].values == alone.values);
}

TEST_CASE("A* is the dose of rays counted one by one") {
  for (const auto& view : {parts::plain_vial, parts::walled_vial}) {
    VialSetup setup = vial_setup(256, 360, view);
    setup.absorption_per_mm = 0.07;
    const VialOperator light(setup);
    Slab image(light.image().width, light.image().height);
    for (const auto [a, c] : indices(image.height, image.width)) {
      *image.at(c, a) = static_cast<float>(shine(setup.projector.x_mm(c), a * setup.turn.step_rad));
    }
    Slab g(light.sinogram().width, light.sinogram().height);
    light.collapse(image, g);
    Slab dose(256, 256);
    light.adjoint({&g, 1}, {&dose, 1});
    vam::oracle::RayDose slow;
    slow.bench.lens_distance = *view.lens_mm;
    for (const auto& shell : view.shells) slow.bench.cylinders.push_back({shell.radius_mm, shell.index});
    slow.half_field = 0.5 * setup.projector.columns * setup.projector.pixel_mm;
    slow.rays = 20000;
    slow.absorption = 0.07;
    slow.angles = 360;
    // Light varies over 3 mm: a disc of 0.1 mm is a point to 1e-4; some 150 rays an angle cross it, each to 1 /
    // 150^1.5.
    for (const auto& [i, j] : {std::pair{128, 137}, {150, 137}, {200, 120}, {60, 100}, {225, 150}}) {
      const double want = vam::oracle::ray_dose(slow, shine, setup.grid.x_mm(i), setup.grid.y_mm(j), 0.1);
      CHECK(std::abs(static_cast<double>(*dose.at(i, j)) / want - 1) < 1.5e-3);
    }
  }
}

TEST_CASE("expand turns the unknowns into fluence, and collapse inverts it") {
  const VialOperator light(vial_setup(40, 60));
  const Slab g = parts::noise(light.sinogram(), 5);
  Slab image(light.image().width, light.image().height);
  Slab back(light.sinogram().width, light.sinogram().height);
  light.expand(g, image);
  light.collapse(image, back);
  for (std::size_t i = 0; i < g.values.size(); ++i) {
    CHECK(static_cast<double>(std::abs(g.values[i] - back.values[i])) < 1e-6);
  }
  CHECK(light.sinogram().width < 440);
}

TEST_CASE("A* filter A is about the identity in the vial, and the preconditioner is symmetric and positive") {
  const VialOperator light(vial_setup(128, 360));
  parts::check_disc_comes_back(light, 0.05, 0.05);
  parts::check_preconditioner(light);
}

TEST_CASE("a projector whose rays miss the vial is an error") {
  VialSetup setup = vial_setup(40, 60);
  setup.projector.axis_column = 5000;
  CHECK(fault_of([&] { VialOperator light(setup); }) == vam::Fault::data);
  setup = vial_setup(40, 60);
  setup.turn.rows = 50;
  CHECK(fault_of([&] { VialOperator light(setup); }) == vam::Fault::data);
}

TEST_CASE("voxels a quarter of a turn apart share their rays: the dose is that of a grid whose voxels do not") {
  for (const bool climbs : {false, true}) {
    for (const int size : {40, 41}) {
      for (const int direction : {1, -1}) {
        VialSetup setup = climbs ? climbing(size, 16, 60) : vial_setup(size, 60);
        setup.direction = direction;
        setup.angle_offset_rad = 0.4;
        setup.absorption_per_mm = 0.07;
        setup.projector.axis_column += 3.3;
        const VialOperator shared(setup);
        setup.grid.ny += 2;  // the same voxels, which a quarter of a turn does not take to voxels
        setup.grid.origin_mm[1] -= setup.grid.voxel_mm;
        const VialOperator alone(setup);
        REQUIRE(alone.sinogram() == shared.sinogram());
        const Slab light = parts::noise(shared.sinogram(), 3);
        Slab dose(size, size), same(size, size + 2);
        shared.adjoint({&light, 1}, {&dose, 1});
        alone.adjoint({&light, 1}, {&same, 1});
        for (std::size_t i = 0; i < dose.values.size(); ++i) {
          const float other = same.values[i + static_cast<std::size_t>(size) * lanes];
          CHECK(static_cast<double>(std::abs(dose.values[i] - other)) < 2e-5);  // of sums of some 30: rounding
        }
      }
    }
  }
}

TEST_CASE("A skips dark voxels: the images of two halves of the voxels add up to that of all") {
  for (const bool climbs : {false, true}) {
    const VialOperator light(climbs ? climbing(40, 90, 36) : vial_setup(40, 36));
    std::vector<Slab> objects, halves[2] = {slabs(6, 40, 40), slabs(6, 40, 40)};
    for (unsigned s = 0; s < 6; ++s) objects.push_back(parts::noise(light.object(), s));
    for (std::size_t s = 0; s < 6; ++s) {
      for (std::size_t i = 0; i < objects[s].values.size(); ++i) {
        halves[i / lanes * 7 % 5 < 2 || s == 4 ? 1 : 0][s].values[i] = objects[s].values[i];
      }
    }
    const light::Shape rows = light.sinogram();
    std::vector<Slab> all = slabs(6, rows.width, rows.height), one = all, other = all;
    light.forward(objects, all);
    light.forward(halves[0], one);
    light.forward(halves[1], other);
    for (std::size_t s = 0; s < 6; ++s) {
      for (std::size_t i = 0; i < all[s].values.size(); ++i) {
        const float sum = one[s].values[i] + other[s].values[i];
        CHECK(static_cast<double>(std::abs(sum - all[s].values[i])) < 2e-5);  // of sums of some 30: rounding
      }
    }
  }
}

TEST_CASE("A of a part of the grid is that of the whole whose other slices are dark") {
  const VialOperator light(climbing(40, 90, 36));
  std::vector<Slab> objects = slabs(6, 40, 40);
  for (std::size_t s = 4; s < 6; ++s) objects[s] = parts::noise(light.object(), 7 + static_cast<unsigned>(s));
  const light::Shape shape = light.sinogram();
  std::vector<Slab> whole = slabs(6, shape.width, shape.height);
  light.forward(objects, whole);
  const SlabRange lit = light.lit_by({4, 6});
  std::vector<Slab> part = slabs(lit.end - lit.first, shape.width, shape.height);
  light.forward_within({4, {objects.data() + 4, 2}}, {lit.first, part});
  for (std::size_t s = 0; s < 6; ++s) {
    const bool inside = s >= lit.first && s < lit.end;
    CHECK(whole[s].values == (inside ? part[s - lit.first].values : slabs(1, shape.width, shape.height)[0].values));
  }
}

TEST_CASE("with skew rays A and A* are adjoint, with slices that do not fill the slabs and around an insert") {
  CHECK(parts::adjoint_error_of_volume(VialOperator(climbing(40, 43, 60)), 3) < 1e-5);
  VialSetup turned = climbing(33, 70, 37);
  turned.direction = -1;
  turned.angle_offset_rad = 0.4;
  turned.absorption_per_mm = 0.07;
  turned.rows = 75;
  turned.first_row_mm = 2.3;
  CHECK(parts::adjoint_error_of_volume(VialOperator(turned), 5) < 1e-5);
  VialSetup wide = climbing(40, 20, 48);
  wide.radius_mm = 12.7;  // beyond the reach, where rays fold
  wide.grid = model::centred_grid(40, 40, 20, 25.0 / 40, 3);
  CHECK(parts::adjoint_error_of_volume(VialOperator(wide), 2) < 1e-5);
  std::vector<Slab> cross = slabs(2, 40, 40);
  for (int k = 8; k < 20; ++k) {
    for (int j = 15; j < 22; ++j) cross[k / lanes].at(18, j)[k % lanes] = 1;
  }
  CHECK(parts::adjoint_error_of_volume(VialOperator(climbing(40, 32, 36), cross), 2) < 1e-5);
}

TEST_CASE("in every pose A and A* are adjoint, with more slices than rows and with more rows than slices") {
  for (const model::Moves moves : {model::Moves::vial, model::Moves::part}) {
    VialSetup tall = posed(climbing(33, 70, 37), 37, moves);
    tall.rows = 40;
    tall.first_row_mm = 4.3;
    CHECK(parts::adjoint_error_of_volume(VialOperator(tall), 5) < 1e-5);
    VialSetup wide = posed(climbing(40, 20, 48), 48, moves);
    wide.absorption_per_mm = 0.07;
    wide.direction = -1;
    wide.radius_mm = 12.7;  // beyond the reach, where rays fold
    wide.grid = model::centred_grid(40, 40, 20, 25.0 / 40, 3);
    wide.rows = 30;
    wide.first_row_mm = 1;
    CHECK(parts::adjoint_error_of_volume(VialOperator(wide), 2) < 1e-5);
    VialSetup level = posed(climbing(40, 20, 48), 48, moves);
    level.view.rows_lens_mm.reset();
    level.z_scale = 1;
    CHECK(parts::adjoint_error_of_volume(VialOperator(level), 2) < 1e-5);
  }
}

TEST_CASE("poses without displacement give the dose without poses") {
  const VialSetup still = climbing(40, 43, 60);
  VialSetup setup = still;
  for (int k = 0; k < 60; ++k) setup.poses.push_back({6.0 * k});
  const VialOperator plain(still);
  const VialOperator posed_light(setup);
  std::vector<Slab> g;
  for (unsigned s = 0; s < 3; ++s) g.push_back(parts::noise(plain.sinogram(), s));
  std::vector<Slab> a = slabs(3, 40, 40);
  std::vector<Slab> b = slabs(3, 40, 40);
  plain.adjoint(g, a);
  posed_light.adjoint(g, b);
  double worst = 0, most = 0;
  for (std::size_t s = 0; s < 3; ++s) {
    for (std::size_t i = 0; i < a[s].values.size(); ++i) {
      const auto column = static_cast<int>(i / lanes);
      // At the rim the table ends, and points without a ray are counted before or after interpolation.
      if (std::hypot(still.grid.x_mm(column % 40), still.grid.y_mm(column / 40)) > 0.94 * still.radius_mm) continue;
      worst = std::max(worst, static_cast<double>(std::abs(a[s].values[i] - b[s].values[i])));
      most = std::max(most, static_cast<double>(std::abs(a[s].values[i])));
    }
  }
  CHECK(worst < 2e-4 * most);  // places in float; noise is steep
}

TEST_CASE("poses that cannot be are errors: too far, too few") {
  VialSetup setup = climbing(20, 8, 24);
  setup.poses.assign(23, {});
  CHECK(fault_of([&] { VialOperator light(setup); }) == vam::Fault::data);
  setup.poses.assign(24, {0, 1.3, 0, 0, model::Moves::vial});
  CHECK(fault_of([&] { VialOperator light(setup); }) == vam::Fault::data);
  setup.poses.assign(24, {0, 1.3, 0, 0, model::Moves::part});
  CHECK_NOTHROW(VialOperator{setup});
}
