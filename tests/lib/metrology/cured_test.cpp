// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/cured.hpp"

#include "metrology/cure/bodies.hpp"
#include "metrology/cure/threshold.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

model::Volume box(const model::Grid& grid, double x0, double x1) {
  model::Volume volume{grid, std::vector<float>(grid.size())};
  for (const auto [k, j, i] : indices(grid.nz, grid.ny, grid.nx)) {
    const bool in = grid.x_mm(i) > x0 && grid.x_mm(i) < x1 && std::abs(grid.y_mm(j)) < 1.05;
    volume.slice(k)[j * grid.nx + i] = in ? 1.0F : 0.0F;
  }
  return volume;
}

}  // namespace

TEST_CASE("cured, missing and overcured volumes of two boxes that overlap by half") {
  const model::Grid grid = model::centred_grid(81, 41, 11, 0.1);
  const auto design = box(grid, -2.05, 0.95);  // 30 x 21 x 11 voxels
  const auto print = box(grid, -0.55, 2.45);
  const Cured state = cured(print, 0.5, {design});
  CHECK(state.cured_mm3 == doctest::Approx(state.target_mm3));
  CHECK(state.missing_mm3 == doctest::Approx(0.5 * state.target_mm3));
  CHECK(state.overcure_mm3 == doctest::Approx(0.5 * state.target_mm3));
  CHECK(state.iou == doctest::Approx(1.0 / 3));
  CHECK(state.missing_percent() == doctest::Approx(50));
  CHECK(cured(design, 0.5, {design}).iou == doctest::Approx(1));
  CHECK_THROWS_AS((void)cured(print, 0.5, {box(grid, 9, 9)}), Error);
}

TEST_CASE("a reference on a finer grid is the same reference") {
  const auto print = box(model::centred_grid(81, 41, 11, 0.1), -2.05, 0.95);
  const auto design = box(model::centred_grid(162, 82, 22, 0.05, -0.025), -2.05, 0.95);
  CHECK(cured(print, 0.5, {design}).iou > 0.99);
}

TEST_CASE("a target that was stretched for rays that climb is the part that they print") {
  const auto print = box(model::centred_grid(81, 41, 20, 0.1), -2.05, 0.95);
  const auto stretched = box(model::centred_grid(81, 41, 25, 0.1), -2.05, 0.95);
  const Cured state = cured(print, 0.5, {stretched, 1.25});
  CHECK(state.target_mm3 == doctest::Approx(state.cured_mm3));
  CHECK(state.missing_percent() == doctest::Approx(0));
  CHECK(state.overcure_percent() == doctest::Approx(0));
  CHECK(neighbourhood({stretched, 1.25}, 0).high[2] == doctest::Approx(1.92));
}

TEST_CASE("of a target on another grid all is missing before anything is cured, and no more") {
  const auto design = box(model::centred_grid(40, 20, 10, 0.2), -2.05, 0.95);
  for (const double voxel_mm : {0.13, 0.17, 0.31}) {
    model::Volume dark{model::centred_grid(61, 41, 21, voxel_mm), {}};
    dark.values.assign(dark.grid.size(), 0.0F);
    CHECK(cured(dark, 0.5, {design}).missing_percent() == doctest::Approx(100));
  }
}

TEST_CASE("sum projections are seen from above, the front and the side, z and y upwards") {
  const model::Grid grid{3, 4, 5, 0.5, {0, 0, 0}};
  model::Volume volume{grid, std::vector<float>(grid.size())};
  volume.slice(1)[2 * 3 + 0] = 7;  // i 0, j 2, k 1
  const auto sums = sum_projections(volume);
  CHECK(sums.along_z(0, 4 - 1 - 2) == 3.5F);
  CHECK(sums.along_y(0, 5 - 1 - 1) == 3.5F);
  CHECK(sums.along_x(2, 5 - 1 - 1) == 3.5F);
  CHECK(sum_projections(volume, 6).along_z(0, 1) == 0.5F);
  CHECK(sum_projections(volume, 8).along_z(0, 1) == 0.0F);
}

TEST_CASE("the threshold from a noisy standard cylinder reproduces its diameter within 0.1 mm") {
  // A 12 mm cylinder whose edge is blurred by 0.4 mm, 0.155 mm pixels, off centre, noise of 3 %.
  const double pixel_mm = 0.155;
  Image overhead(120, 110);
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.03F);
  const auto edge = [](double r_mm) { return 0.9 * 0.5 * std::erfc((r_mm - 6) / (0.4 * std::numbers::sqrt2)); };
  for (const auto [y, x] : indices(110, 120)) {
    overhead(x, y) = static_cast<float>(edge(pixel_mm * std::hypot(x - 62.3, y - 53.8))) + noise(random);
  }
  const Threshold found = gelation_threshold(overhead, pixel_mm, 12);
  CHECK(found.circle.x == doctest::Approx(62.3).epsilon(0.002));
  CHECK(found.circle.y == doctest::Approx(53.8).epsilon(0.002));
  CHECK(found.isovalue == doctest::Approx(0.45).epsilon(0.05));
  CHECK(found.spread < 0.1);
  // Where the true profile falls through the isovalue: the diameter that this threshold makes.
  double r = 0;
  while (edge(r) > found.isovalue) r += 0.001;
  CHECK(std::abs(2 * r - 12) < 0.1);
  CHECK(std::abs(found.apparent_diameter_mm - 12) < 0.1);
}

TEST_CASE("a standard that the edge of the volume cuts is refused") {
  // A disc of 6 mm in volumes of 16, 12.8 and 8 mm, and off the axis.
  const auto overhead = [](int size, double off_px) {
    Image image(size, size);
    const double middle = 0.5 * (size - 1);
    for (const auto [y, x] : indices(size, size)) {
      const double r = std::hypot(x - middle - off_px, y - middle);
      const bool seen = std::hypot(x - middle, y - middle) < 0.5 * size;
      image(x, y) = seen ? static_cast<float>(1 / (1 + std::exp(2 * (r - 30)))) : 0.0F;
    }
    return image;
  };
  CHECK(gelation_threshold(overhead(160, 0), 0.1, 6).isovalue == doctest::Approx(0.5).epsilon(0.1));
  CHECK(gelation_threshold(overhead(128, 0), 0.1, 6).isovalue == doctest::Approx(0.5).epsilon(0.1));
  CHECK_THROWS_WITH_AS((void)gelation_threshold(overhead(80, 14), 0.1, 6), doctest::Contains("cut by the edge"), Error);
  CHECK_THROWS_WITH_AS((void)gelation_threshold(overhead(160, 0), 0.1, 16), doctest::Contains("cut by the edge"),
                       Error);
}

TEST_CASE("no circle, no threshold") { CHECK_THROWS_AS((void)gelation_threshold(Image(50, 50, 1.0F), 0.1, 3), Error); }
