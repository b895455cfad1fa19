// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/filtered_projections.hpp"

#include "testing.hpp"
#include "tomo/fbp.hpp"

using namespace vam;
using namespace vam::tomo;

TEST_CASE("projections of a Gaussian in closed form: lengths in mm, and filtered light per radian") {
  constexpr double pi = std::numbers::pi;
  constexpr double sigma = 10;
  constexpr int n = 128;
  ProjectionSpec spec{.geometry = full_turn(vam::model::centred_grid(n, n, 1, 1.0), 16), .voxel_mm = 0.1};
  std::vector<Slab> image{Slab(n, n)};
  for (const auto [j, i] : indices(n, n)) {
    const double r = std::hypot(i - spec.geometry.axis_x, j - spec.geometry.axis_y);
    *image[0].at(i, j) = static_cast<float>(std::exp(-0.5 * r * r / (sigma * sigma)));
  }
  const int middle = spec.geometry.columns / 2;
  const double t = middle - 0.5 * (spec.geometry.columns - 1);
  std::vector<Slab> sinogram{Slab(spec.geometry.columns, spec.geometry.angles)};
  const auto at_the_axis = [&] {
    FilteredProjections(spec).apply(image, sinogram);
    return static_cast<double>(*sinogram[0].at(middle, 3));
  };
  // Footprint and bin blur by a variance of 1/6 px^2: 0.2 % of these.
  const double length_mm = 0.1 * std::sqrt(2 * pi) * sigma * std::exp(-0.5 * t * t / (sigma * sigma));
  CHECK(at_the_axis() == doctest::Approx(length_mm).epsilon(0.005));
  // The ramp |f| gives (1 - t^2 / sigma^2) / pi near the axis, whatever sigma; half of it a radian of a full turn.
  spec.filter.window = FilterWindow::ram_lak;
  CHECK(at_the_axis() == doctest::Approx((1 - t * t / (sigma * sigma)) / (2 * pi)).epsilon(0.005));
}

TEST_CASE("as many slabs a pass as the budget holds, one at least and four at most") {
  ParallelGeometry geometry{.nx = 10, .ny = 20, .columns = 30, .angles = 40};
  const std::size_t slab = (2 * 10 * 20 + 3 * 30 * 40) * lanes * sizeof(float);
  CHECK(slabs_a_pass(geometry, 0) == 1);
  CHECK(slabs_a_pass(geometry, 2 * slab - 1) == 1);
  CHECK(slabs_a_pass(geometry, 2 * slab) == 2);
  CHECK(slabs_a_pass(geometry, 4 * slab) == 4);
  CHECK(slabs_a_pass(geometry, 100 * slab) == 4);
}
