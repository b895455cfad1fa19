// SPDX-License-Identifier: GPL-3.0-or-later
// Where parts land, and which grid holds them.
#include "solid/voxel/placement.hpp"

#include "oracle/meshes.hpp"
#include "solid/shapes/shapes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

namespace {

const Writable room{8, -20, 20};

PlacedExtent placed(model::TriangleSoup mesh, const Placement& placement) {
  transform(mesh, place(mesh, placement, room, "test"));
  return extent(mesh);
}

std::string data_error(const std::function<void()>& work) { return error_of(work, Fault::data); }

}  // namespace

TEST_CASE("a size that is typed is rounded down to three digits, as written") {
  CHECK(three_digits(0.41567) == 0.415);
  CHECK(three_digits(0.415) == 0.415);
  CHECK(three_digits(0.1 * 3) == 0.3);
  CHECK(three_digits(0.0019199) == 0.00191);
  CHECK(three_digits(1.2e-7) == 1.2e-7);
  CHECK(three_digits(1) == 1);
  CHECK(three_digits(123.9) == 123);
  CHECK(three_digits(98765) == 98700);
}

TEST_CASE("rotations are right-handed, about x, then y, then z; quarter turns are exact") {
  CHECK(rotation({90, 0, 0})({0, 1, 0}) == Point{0, 0, 1});
  CHECK(rotation({0, 90, 0})({0, 0, 1}) == Point{1, 0, 0});
  CHECK(rotation({0, 0, 90})({1, 0, 0}) == Point{0, 1, 0});
  CHECK(rotation({90, 0, 90})({0, 1, 0}) == Point{0, 0, 1});  // y to z, which z leaves alone
  const Affine turn = rotation({10, 20, 30});
  const Point there{1, 2, 3};
  const Point back = inverse(turn)(turn(there));
  for (std::size_t a = 0; a < 3; ++a) CHECK(back[a] == doctest::Approx(there[a]));
}

TEST_CASE("scale, rotate, fit, centre, stretch, in this order") {
  const model::TriangleSoup brick = vam::oracle::box({10, 10, 10}, {12, 14, 11});
  Placement placement{.centre = false};
  CHECK(placed(brick, placement).box.high == Point{12, 14, 11});
  placement.scale = 2;
  CHECK(placed(brick, placement).box.high == Point{24, 28, 22});
  placement.centre = true;
  CHECK(placed(brick, placement).box.high == Point{2, 4, 1});
  placement.rotate_deg = {90, 0, 0};  // its length stands up
  CHECK(placed(brick, placement).box.high == Point{2, 1, 4});
  placement.fit_mm = 4;
  CHECK(placed(brick, placement).box.high == Point{1, 0.5, 2});
  placement.stretch_z = 1.25;
  CHECK(placed(brick, placement).box.high == Point{1, 0.5, 2.5});
}

TEST_CASE("to fit the writable cylinder") {
  Placement placement{.fit_writable = true, .stretch_z = 1.1};
  const PlacedExtent flat = placed(vam::oracle::box({0, 0, 0}, {6, 8, 1}), placement);
  CHECK(flat.radius_mm == doctest::Approx(8));  // bound by the circle
  const PlacedExtent tall = placed(vam::oracle::box({0, 0, 0}, {1, 1, 30}), placement);
  CHECK(tall.box.high[2] == doctest::Approx(20));  // bound by the rows, after stretching
  const Field shape = make_shape("hollow-cylinder");
  CHECK(transformed(shape, place(shape, placement, room, "test")).radius_mm == doctest::Approx(8).epsilon(1e-4));
  placement.voxel_mm = 0.5;  // the centres of voxels that the surface cuts are up to half a diagonal beyond it
  CHECK(placed(vam::oracle::box({0, 0, 0}, {6, 8, 1}), placement).radius_mm == doctest::Approx(8 - 0.5 / std::sqrt(2)));
  placement.voxel_mm = 12;
  CHECK(data_error([&] { (void)place(shape, placement, room, "test"); }).find("use smaller voxels") !=
        std::string::npos);
}

TEST_CASE("grids: centred, even, faces at whole voxels, the part inside") {
  PlacedExtent part;
  part.box.add({-1.23, -2.01, -0.77});
  part.box.add({1.23, 2.01, 3.14});
  part.radius_mm = 2.36;
  const model::Grid grid = grid_around(part, 0.1, 0, {}, "test");
  CHECK(grid.nx == grid.ny);
  CHECK(grid.nx == 2 * 25);
  CHECK(grid.x_mm(0) == doctest::Approx(-grid.x_mm(grid.nx - 1)));
  CHECK(grid.z_mm(-0.5) == doctest::Approx(-0.8));
  CHECK(grid.z_mm(grid.nz - 0.5) == doctest::Approx(3.2));
  CHECK(grid_around(part, 0.1, 8.3, {}, "test").nx == 2 * 84);
  const model::Grid odd = grid_around(part, 0.1, 0, {true, 0.5}, "test");
  CHECK(odd.nx % 2 == 1);
  CHECK(odd.x_mm(odd.nx / 2) == doctest::Approx(0));
  CHECK(odd.x_mm(odd.nx - 0.5) >= part.radius_mm);
  CHECK(odd.z_mm(-0.5) == doctest::Approx(-0.85));
  CHECK(data_error([&] { (void)grid_around(part, 1e-3, 0, {}, "test"); }).find("4096") != std::string::npos);
}

TEST_CASE("slices begin where rows do, wherever the lens is, with voxels of any size") {
  PlacedExtent part;
  part.box.add({-1, -1, -0.77});
  part.box.add({1, 1, 3.14});
  part.radius_mm = 1.5;
  model::Projector projector;  // 768 rows of 0.065 mm
  CHECK(row_lattice(projector, 0.065).z_phase == 0);
  for (const double axis_row : {383.5, 383.0, 700.2, -20.9}) {
    projector.axis_row = axis_row;
    for (const double pixels : {1.0, 2.0, 1.7, 0.4}) {
      const double voxel_mm = pixels * projector.pixel_mm;
      const model::Grid grid = grid_around(part, voxel_mm, 0, row_lattice(projector, voxel_mm), "test");
      const double row = projector.axis_row - grid.z_mm(-0.5) / projector.pixel_mm + 0.5;  // of the lower face
      if (pixels >= 1 && pixels != 1.7) CHECK(std::abs(row - std::round(row)) < 1e-6);
      CHECK(grid.z_mm(-0.5) <= -0.77);
      CHECK(grid.z_mm(grid.nz - 0.5) >= 3.14);
      CHECK(grid.z_mm(0.5) > -0.77);
    }
  }
}

TEST_CASE("a thin rod may have 65536 slices, and no more") {
  PlacedExtent rod{.box = {{-0.012, -0.012, 0}, {0.012, 0.012, 65.536}}, .radius_mm = 0.012};
  CHECK(grid_around(rod, 1e-3, 0, {}, "test").nz == 65536);
  rod.box.high[2] += 1e-3;
  CHECK(data_error([&] {
          (void)grid_around(rod, 1e-3, 0, {}, "test");
        }).find("26 x 26 x 65537 voxels of 0.001 mm are more than 4096 per axis in 65536 slices") != std::string::npos);
}

TEST_CASE("a part that leaves the writable cylinder is refused with both numbers") {
  const model::Printer printer;
  const Writable real = writable(printer, 12.7 / 1.53);
  CHECK(real.radius_mm == doctest::Approx(12.7 / 1.53));
  CHECK(real.high_mm - real.low_mm == doctest::Approx(768 * 0.065));
  CHECK(real.high_mm == doctest::Approx(-real.low_mm));
  PlacedExtent part;
  part.box.add({-9, -1, -1});
  part.box.add({9, 1, 1});
  part.radius_mm = 9.055;
  CHECK(data_error([&] {
          require_writable(part, real, 0.1, "part");
        }).find("9.055 mm (90.55 voxels) from the axis, beyond the writable radius of 8.301 mm (83.01 voxels)") !=
        std::string::npos);
  part.radius_mm = 8;
  part.box.high[2] = 26;
  CHECK(data_error([&] {
          require_writable(part, real, 0.1, "part");
        }).find("26 mm, but the projector's rows cover -24.96 ... 24.96 mm") != std::string::npos);
}

TEST_CASE("the refusal names the value that fits, rounded down, and it does fit") {
  PlacedExtent part;
  part.box.add({-10, -20, -40});
  part.box.add({10, 20, 30});
  part.radius_mm = std::hypot(10, 20);
  CHECK(fitting_factor(part, room, 0) == doctest::Approx(8 / part.radius_mm));
  CHECK(fitting_factor(part, room, 0.5) == doctest::Approx((8 - 0.5 / std::sqrt(2)) / part.radius_mm));
  PlacedExtent tall = part;
  tall.radius_mm = 1;
  CHECK(fitting_factor(tall, room, 0) == doctest::Approx(40.0 / 70));
  CHECK(fitting_factor(tall, {8, -2, 38}, 0.5) == doctest::Approx(39.5 / 70));  // lifted by whole voxels
  const auto sized = [](const char* size, double value, double stretch_z) {
    PlacementAdvice advice{.size = size, .value = value, .stretch_z = stretch_z, .or_fit = " or --fit"};
    return advice;
  };
  const auto has = [&](const std::string& words, const PlacementAdvice& size) {
    return data_error([&] { require_writable(part, room, 0.5, "part", size); }).find(words) != std::string::npos;
  };
  CHECK(has("part: 20 x 40 x 70 mm, reaches 22.36 mm", {}));
  CHECK(has("; give scale 0.341 to make it fit", {}));  // 7.646 / 22.36 = 0.34196
  CHECK(has("; give --scale 8.68 or --fit to make it fit", sized("--scale", 25.4, 1)));
  CHECK(has("; give --fit 23.9 or --fit to make it fit", sized("--fit", 70, 1)));
  CHECK(has("20 x 40 x 50 mm", sized("scale", 1, 1.4)));
}

TEST_CASE("which axis of the file points up, and mirrors") {
  const Point there{1, 2, 3};
  CHECK(upright("z")(there) == there);
  CHECK(upright("y")(there) == Point{1, -3, 2});
  CHECK(upright("-y")(there) == Point{1, 3, -2});
  CHECK(upright("x")(there)[2] == 1);
  CHECK(upright("-x")(there)[2] == -1);
  CHECK(upright("-z")(there)[2] == -3);
  CHECK(mirrored("x")(there) == Point{-1, 2, 3});
  CHECK(mirrored("z")(there) == Point{1, 2, -3});
  CHECK(placed(vam::oracle::box({0, 0, 0}, {2, 8, 4}), Placement{.axes = upright("y")}).box.high == Point{1, 2, 4});
}

TEST_CASE("a mirror turns triangles over, so that outside stays outside") {
  model::TriangleSoup mesh = vam::oracle::box({-1, -1, -1}, {1, 1, 1});
  transform(mesh, scaling({-1, 1, 1}));
  CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(8));
}
