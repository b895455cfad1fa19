// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/fbp.hpp"

#include "testing.hpp"
#include "tomo/filtered_projections.hpp"

using namespace vam;
using namespace vam::tomo;

namespace {

constexpr double pi = std::numbers::pi;

struct Gaussian {
  double x, y, sigma;  // px, from the axis
  [[nodiscard]] double value(double px, double py) const {
    const double dx = px - x;
    const double dy = py - y;
    return std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
  }
  /// int f e^{alpha u} du along the line (t, theta), in closed form: complete the square in u.
  [[nodiscard]] double projection(double t, double theta, double alpha) const {
    const double t0 = x * std::cos(theta) + y * std::sin(theta);
    const double u0 = -x * std::sin(theta) + y * std::cos(theta);
    const double across = (t - t0) / sigma;
    return std::sqrt(2 * pi) * sigma *
           std::exp(alpha * u0 + 0.5 * alpha * alpha * sigma * sigma - 0.5 * across * across);
  }
};

ParallelGeometry geometry_of(int n, int angles, double alpha) {
  ParallelGeometry g = full_turn(vam::model::centred_grid(n, n, 1, 1.0), angles);
  g.alpha_per_px = alpha;
  return g;
}

double worst_error(const Slab& image, const ParallelGeometry& g, const Gaussian& truth) {
  double worst = 0;
  for (const auto [j, i] : indices(g.ny, g.nx)) {
    if (std::hypot(i - g.axis_x, j - g.axis_y) > g.nx / 2.0) continue;
    const double want = truth.value(i - g.axis_x, j - g.axis_y);
    worst = std::max(worst, std::abs(static_cast<double>(*image.at(i, j)) - want));
  }
  return worst;
}

}  // namespace

TEST_CASE("fbp of a Gaussian's exponential projections in closed form returns the Gaussian, to second order") {
  // The adjoint blurs by the bin and the pixel's shadow: 2 * (1 + 1) / (24 sigma^2) of the peak = 1.2e-3 for sigma 12.
  // 720 angles, because e^{-alpha u} widens the angular spectrum.
  for (const double alpha_radius : {0.0, 0.5, -1.0, 2.0}) {
    CAPTURE(alpha_radius);
    double errors[2];
    for (const int refinement : {1, 2}) {
      const int n = 64 * refinement;
      const Gaussian truth{6.5 * refinement, -11.0 * refinement, 6.0 * refinement};
      const double alpha = alpha_radius / (n / 2.0);
      const ParallelGeometry g = geometry_of(n, 720, alpha);
      Slab sinogram(g.columns, g.angles);
      for (const auto [a, c] : indices(g.angles, g.columns)) {
        const double value = truth.projection(c - 0.5 * (g.columns - 1), a * g.angle_step_rad, alpha);
        *sinogram.at(c, a) = static_cast<float>(value);
      }
      errors[refinement - 1] = worst_error(fbp(g, sinogram), g, truth);
    }
    CHECK(errors[1] < 2e-3);
    CHECK(errors[0] / errors[1] > 3.5);  // second order: 4
  }
}

TEST_CASE("forward of a sampled Gaussian has its exponential projections") {
  const Gaussian truth{-9, 17, 10};
  const double alpha = 0.03;
  const ParallelGeometry g = geometry_of(128, 40, alpha);
  std::vector<Slab> image{Slab(128, 128)};
  for (const auto [j, i] : indices(128, 128))
    *image[0].at(i, j) = static_cast<float>(truth.value(i - g.axis_x, j - g.axis_y));
  std::vector<Slab> sinogram{Slab(g.columns, g.angles)};
  forward(g, image, sinogram);
  double worst = 0;
  double peak = 0;
  for (const auto [a, c] : indices(g.angles, g.columns)) {
    const double want = truth.projection(c - 0.5 * (g.columns - 1), a * g.angle_step_rad, alpha);
    worst = std::max(worst, std::abs(static_cast<double>(*sinogram[0].at(c, a)) - want));
    peak = std::max(peak, want);
  }
  CHECK(worst < 2e-3 * peak);  // the footprint and the bin blur by 2 / (24 sigma^2) = 0.8e-3 of the peak
}

TEST_CASE("fbp of a disc is flat inside and empty outside") {
  const ParallelGeometry g = geometry_of(256, 403, 0);  // odd: opposite angles fall between each other
  std::vector<Slab> image{Slab(256, 256)};
  const double radius = 80;
  const auto distance = [&](int i, int j) { return std::hypot(i - g.axis_x - 20, j - g.axis_y + 15); };
  for (int j = 0; j < 256; ++j) {
    for (int i = 0; i < 256; ++i)
      *image[0].at(i, j) = static_cast<float>(std::clamp(radius + 0.5 - distance(i, j), 0.0, 1.0));
  }
  std::vector<Slab> sinogram{Slab(g.columns, g.angles)};
  forward(g, image, sinogram);
  const Slab back = fbp(g, sinogram[0], {FilterWindow::hann, 1, 0, 0});
  for (const auto [j, i] : indices(256, 256)) {
    const double value = static_cast<double>(*back.at(i, j));
    if (distance(i, j) < radius - 4) CHECK(std::abs(value - 1) < 0.01);
    if (distance(i, j) > radius + 4) CHECK(std::abs(value) < 0.01);
  }
}

TEST_CASE("half a turn gives the same image as a full one") {
  const Gaussian truth{5, 8, 9};
  ParallelGeometry full = geometry_of(64, 180, 0);
  ParallelGeometry half = full;
  half.angles = 90;
  std::vector<Slab> image{Slab(64, 64)};
  for (const auto [j, i] : indices(64, 64))
    *image[0].at(i, j) = static_cast<float>(truth.value(i - full.axis_x, j - full.axis_y));
  std::vector<Slab> a{Slab(full.columns, 180)};
  std::vector<Slab> b{Slab(full.columns, 90)};
  forward(full, image, a);
  forward(half, image, b);
  const Slab from_full = fbp(full, a[0]);
  const Slab from_half = fbp(half, b[0]);
  for (std::size_t i = 0; i < from_full.values.size(); ++i) {
    CHECK(from_full.values[i] == doctest::Approx(from_half.values[i]).epsilon(1e-5).scale(1));
  }
}

TEST_CASE("full_turn covers the corners of the grid, axis in the middle") {
  CHECK(full_turn(vam::model::centred_grid(512, 512, 1, 0.1), 360).columns == 726);
  CHECK(full_turn(vam::model::centred_grid(511, 511, 1, 0.1), 360).columns == 723);
  const vam::model::Grid shifted{20, 10, 1, 0.5, {-2.0, -1.0, 0}};
  const ParallelGeometry g = full_turn(shifted, 8, 0, 0.3);
  CHECK(g.axis_x == doctest::Approx(4));
  CHECK(g.axis_y == doctest::Approx(2));
  CHECK(g.alpha_per_px == doctest::Approx(0.15));
  CHECK(g.columns >= 2 * std::hypot(15.5, 7.5));
  CHECK(full_turn(shifted, 8, 12).columns == 12);
  CHECK_THROWS_AS(static_cast<void>(full_turn(shifted, 0)), vam::Error);
}

TEST_CASE("fbp refuses angles it cannot invert") {
  ParallelGeometry g = geometry_of(16, 20, 0);
  g.angle_step_rad = 0.1;
  CHECK_THROWS_AS(static_cast<void>(fbp(g, Slab(g.columns, g.angles))), vam::Error);
}

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
