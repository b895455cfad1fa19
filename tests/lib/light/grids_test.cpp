// SPDX-License-Identifier: GPL-3.0-or-later
// The grids of doses and of lit resin.
#include "light/grids/dose_grid.hpp"
#include "light/grids/lit_grid.hpp"
#include "model/rows.hpp"
#include "optics/skew_ray.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

model::StackInfo sinogram() {
  model::StackInfo info;
  info.kind = model::Kind::sinogram;
  info.space = model::Space::virtual_;
  info.width = 10;
  info.count = 4;
  info.pixel_mm = info.row_mm = 0.5;
  info.z_start_mm = 1;
  return info;
}

model::Printer telecentric() {
  model::Printer printer;
  printer.projector.telecentric = true;
  return printer;
}

model::Pose lifted(double mm) { return {.dz_mm = mm}; }

}  // namespace

TEST_CASE("the dose of a sinogram has cubes as wide as its columns, the width of the detector or the one given") {
  const model::Printer printer = telecentric();
  model::StackInfo info = sinogram();
  const model::Grid grid = dose_grid(printer, info, {});
  CHECK(grid.nx == 10);
  CHECK(grid.ny == 10);
  CHECK(grid.nz == 4);
  CHECK(grid.voxel_mm == 0.5);
  CHECK(grid.x_mm(0) == -2.25);
  CHECK(grid.z_mm(0) == 1);
  CHECK(dose_grid(printer, info, 2.0).nx == 4);
  CHECK(dose_grid(printer, info, 2.1).nx == 5);
  CHECK(dose_grid(printer, info, 0.1).nx == 1);
  info.row_mm = 0.5 * 1.0009;
  CHECK_NOTHROW((void)dose_grid(printer, info, {}));
  info.row_mm = 0.5 * 1.0011;
  CHECK(fault_of([&] { (void)dose_grid(printer, info, {}); }) == Fault::data);
  info.row_mm = 0;  // one slice
  CHECK(dose_grid(printer, info, {}).voxel_mm == 0.5);
  info.row_mm = 0.5;
  info.poses = {lifted(-1), lifted(0.3), lifted(0)};
  const model::Grid passed = dose_grid(printer, info, {});
  CHECK(passed.nz == 1 + 4 + 2);
  CHECK(passed.z_mm(0) == 0.5);
}

TEST_CASE("a stack lies in a volume on its slices, to a hundredth of a voxel") {
  const model::Grid grid = model::centred_grid(4, 4, 10, 0.5);
  model::StackInfo info = sinogram();
  CHECK(first_slice(grid, info) == 2);
  const auto refused = [&](double z_start_mm, double row_mm, int count) {
    info.z_start_mm = z_start_mm;
    info.row_mm = row_mm;
    info.count = count;
    return fault_of([&] { (void)first_slice(grid, info); }) == Fault::data;
  };
  CHECK_FALSE(refused(1.0045, 0.5, 4));
  CHECK(refused(1.0055, 0.5, 4));
  CHECK_FALSE(refused(0.9955, 0.5, 4));
  CHECK(refused(0.9945, 0.5, 4));
  CHECK_FALSE(refused(1, 0.5, 8));
  CHECK(refused(1, 0.5, 9));
  CHECK_FALSE(refused(0, 0.5, 10));
  CHECK(refused(-0.5, 0.5, 4));
  CHECK_FALSE(refused(1, 0.5012, 4));  // drifts by 4 x 0.0024 voxels
  CHECK(refused(1, 0.5013, 4));
  CHECK(refused(1, 0.4987, 4));
  CHECK_FALSE(refused(1, 0, 4));  // not known
}

TEST_CASE("level light reaches the circle, and a slice more where the part is lifted") {
  const model::Grid grid = model::centred_grid(10, 12, 4, 0.5, 1);  // 2.5 mm to the nearer rim
  Margin margin = lit_margin(telecentric(), grid, 3.1, {});
  CHECK(margin.side == 2);
  CHECK(margin.below == 0);
  CHECK(margin.above == 0);
  CHECK(lit_margin(telecentric(), grid, 3, {}).side == 1);
  CHECK(lit_margin(telecentric(), grid, 2, {}).side == 0);
  for (const model::Poses& poses : {model::Poses{lifted(0), lifted(0.1)}, {lifted(-0.1), lifted(0)}}) {
    margin = lit_margin(telecentric(), grid, 3.1, poses);
    CHECK(margin.below == 1);
    CHECK(margin.above == 1);
  }
  CHECK(lit_margin(telecentric(), grid, 3.1, {lifted(0), lifted(0)}).above == 0);
  const model::Grid all = extended(grid, {2, 3, 4});
  CHECK(all.nx == 14);
  CHECK(all.ny == 16);
  CHECK(all.nz == 11);
  CHECK(all.x_mm(2) == doctest::Approx(grid.x_mm(0)));
  CHECK(all.y_mm(2) == doctest::Approx(grid.y_mm(0)));
  CHECK(all.z_mm(3) == doctest::Approx(grid.z_mm(0)));
}

TEST_CASE("light that climbs reaches above and below a part by the rays through its ends") {
  const model::Printer printer;
  const double radius_mm = 10;
  const optics::SkewRay low = optics::skew_ray(optics::projector_view(printer), 0, 0.01);
  const double near = std::min(low.z_mm(-radius_mm), low.z_mm(radius_mm));
  const double ratio = std::max(low.z_mm(-radius_mm), low.z_mm(radius_mm)) / near;
  REQUIRE(ratio > 1.05);
  constexpr double voxel = 0.01;  // so that 2 % are seen
  const auto slices = [&](double mm) { return static_cast<int>(std::ceil(mm / voxel - 1e-6)) + 1; };
  const auto margin = [&](double from_mm, double to_mm, const model::Poses& poses) {
    const int nz = static_cast<int>(std::lround((to_mm - from_mm) / voxel)) + 1;
    return lit_margin(printer, model::centred_grid(4, 4, nz, voxel, from_mm), radius_mm, poses);
  };
  const auto near_to = [](int got, int want) {
    return std::abs(got - want) <= 1;
  };  // rays climb a little less higher up
  CHECK(near_to(margin(-5, 8, {}).above, slices(8 * (ratio - 1))));
  CHECK(near_to(margin(-5, 8, {}).below, slices(5 * (ratio - 1))));
  CHECK(near_to(margin(3, 8, {}).below, slices(3 * (1 - 1 / ratio))));  // an end that rays come to from within
  CHECK(near_to(margin(-8, -3, {}).above, slices(3 * (1 - 1 / ratio))));
  // Lifted, it is lit where it passes the image.
  const double top_mm = model::z_mm(printer.projector, 0);
  CHECK(near_to(margin(-5, 8, {lifted(0), lifted(1000)}).above, slices(top_mm * (ratio - 1))));
  CHECK(near_to(margin(-5, 8, {lifted(-1000), lifted(0)}).below,
                slices(-model::z_mm(printer.projector, printer.projector.rows - 1) * (ratio - 1))));
}
