// SPDX-License-Identifier: GPL-3.0-or-later
#include "lib/light/vial_dose.hpp"

#include "base/compute/parallel.hpp"
#include "optics/writable_radius.hpp"
#include "oracle/ray_dose.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optics;
using namespace vam::light;
using parts::dose_of;
using parts::doses_of;

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
const View vial{119.808, 1.0, 0.0, {{12.7, 1.53}}};             // [RAY21]
const View walled{60, 1.0, 0.0, {{12.7, 1.47}, {11.5, 1.51}}};  // a glass wall, a short throw
const View matched{std::nullopt, 1.53, 20, {{12.7, 1.53}}};     // telecentric in a bath

VialSetup setup_of(const View& view, int n, double size_mm, int angles = 360, int columns = 440,
                   double pixel_mm = 0.065) {
  VialSetup setup{.view = view,
                  .projector = centred_detector(columns, pixel_mm),
                  .turn = {angles, 0, turn_rad / angles},
                  .grid = model::centred_grid(n, n, 1, size_mm / n)};
  return setup;
}

Image sinogram(const VialSetup& setup, const std::function<double(double, double)>& intensity) {
  Image image(setup.projector.columns, setup.turn.rows);
  for (const auto [a, c] : indices(image.height, image.width)) {
    image(c, a) = static_cast<float>(intensity(setup.projector.x_mm(c), a * setup.turn.step_rad));
  }
  return image;
}

double radius_of(const model::Grid& grid, int i, int j) { return std::hypot(grid.x_mm(i), grid.y_mm(j)); }

// Line integrals of a Gaussian at (3, 1) mm and its back-projection, by quadrature fine enough to be exact.
double blob(double t_mm, double theta) {
  const double offset = t_mm - (3 * std::cos(theta) + std::sin(theta));
  return std::exp(-0.5 * offset * offset / (0.8 * 0.8));
}
double back_projected(double x, double y) {
  double sum = 0;
  for (int a = 0; a < 2000; ++a) {
    const double theta = turn_rad * a / 2000;
    sum += blob(x * std::cos(theta) + y * std::sin(theta), theta);
  }
  return sum * turn_rad / 2000;
}

// The exact correction: what the resampler should compute, from the map itself.
double corrected(const View& view, double x_p, double theta) {
  const ChiefRay ray = chief_ray(view, x_p);
  return ray.hits ? blob(ray.x_v_mm, theta + ray.delta_rad) * ray.jacobian / ray.transmittance : 0.0;
}

// Smooth light without symmetry.
double smooth_light(double x_p, double theta) { return 1.2 + std::sin(0.35 * x_p + 2 * theta) + 0.1 * std::cos(theta); }

vam::oracle::RayDose counted(const VialSetup& setup) {
  vam::oracle::RayDose slow;
  slow.bench.lens_distance = *setup.view.lens_mm;
  for (const Shell& shell : setup.view.shells) slow.bench.cylinders.push_back({shell.radius_mm, shell.index});
  slow.half_field = 0.5 * setup.projector.columns * setup.projector.pixel_mm;
  slow.rays = 20000;
  slow.absorption = setup.absorption_per_mm;
  slow.angles = setup.turn.rows;
  return slow;
}

}  // namespace

TEST_CASE("a matched telecentric bench lights only the resin, and evenly") {
  VialSetup setup = setup_of(matched, 64, 30);
  const double window = chief_ray(matched, 0).transmittance;
  const Image dose = dose_of(setup, Image(440, 360, 1.0F));
  for (const auto [j, i] : indices(64, 64)) {
    const double r = radius_of(setup.grid, i, j);
    // A voxel of 0.47 mm that is wholly resin; sums of 360 floats.
    if (r < 12.3) CHECK(std::abs(dose(i, j) - turn_rad * window) < 1e-5 * turn_rad);
    if (r > 12.7) CHECK(dose(i, j) == 0);
  }
}

TEST_CASE("intensity weighted by J/T exposes the writable circle evenly, through lens and glass") {
  for (const View& view : {vial, walled}) {
    VialSetup setup = setup_of(view, 96, 2 * reach_mm(view));
    const Image dose = dose_of(setup, sinogram(setup, [&](double x_p, double) {
                                 const ChiefRay ray = chief_ray(view, x_p);
                                 return ray.hits ? ray.jacobian / ray.transmittance : 0.0;
                               }));
    for (const auto [j, i] : indices(96, 96)) {
      // Up to where J/T, which grows without bounds at the rim, is curved on the scale of a column.
      if (radius_of(setup.grid, i, j) > 0.9 * reach_mm(view)) continue;
      CHECK(std::abs(dose(i, j) / turn_rad - 1) < 1e-4);
    }
  }
}

TEST_CASE("absorption: the mean of e^{-mu s} over all directions") {
  VialSetup setup = setup_of(matched, 48, 24);
  setup.absorption_per_mm = 1 / 12.7;
  const double window = chief_ray(matched, 0).transmittance;
  const Image dose = dose_of(setup, Image(440, 360, 1.0F));
  for (const auto [j, i] : indices(48, 48)) {
    const double r = radius_of(setup.grid, i, j);
    if (r > 11) continue;
    double want = 0;
    for (int k = 0; k < 2000; ++k) {
      const double b = turn_rad * k / 2000;
      want += std::exp(-(std::sqrt(12.7 * 12.7 - r * r * std::cos(b) * std::cos(b)) + r * std::sin(b)) / 12.7);
    }
    want *= window * turn_rad / 2000;
    CHECK(std::abs(dose(i, j) / want - 1) < 4e-4);
  }
  // Interpolation between the table's radii, 0.25 mm apart: 0.25^2 / 8 * d2/dr2 of mu sqrt(R^2 - r^2) at 11 mm
  // = 3.9e-4.
}

TEST_CASE("the exact correction gives the parallel dose, with order 2 in the pitch") {
  const auto error = [](int fineness) {
    VialSetup setup = setup_of(vial, 32 * fineness, 16, 180 * fineness, 110 * fineness + 1, 0.26 / fineness);
    const Image dose =
        dose_of(setup, sinogram(setup, [](double x_p, double theta) { return corrected(vial, x_p, theta); }));
    double most = 0;
    for (const auto [j, i] : indices(setup.grid.ny, setup.grid.nx)) {
      if (radius_of(setup.grid, i, j) > 0.95 * reach_mm(vial)) continue;
      most = std::max(most, std::abs(dose(i, j) - back_projected(setup.grid.x_mm(i), setup.grid.y_mm(j))));
    }
    return most / back_projected(3, 1);
  };
  const double coarse = error(1);
  const double fine = error(2);
  CHECK(coarse < 0.03);             // voxel^2 / 24 * laplacian = 0.5^2 / 24 * 2 / 0.8^2 = 0.033
  CHECK(coarse / fine > 0.85 * 4);  // second order, less the margin of the next
}

TEST_CASE("rays counted one by one leave the same dose within the reach") {
  for (const View& view : {vial, walled}) {
    VialSetup setup = setup_of(view, 256, 25.6);
    setup.absorption_per_mm = 0.07;
    const Image dose = dose_of(setup, sinogram(setup, smooth_light));
    const vam::oracle::RayDose slow = counted(setup);
    const auto relative = [&](int i, int j, double radius) {
      return dose(i, j) / vam::oracle::ray_dose(slow, smooth_light, setup.grid.x_mm(i), setup.grid.y_mm(j), radius) - 1;
    };
    // Light varies over 3 mm: a disc of 0.1 mm is a point to 1e-4; some 150 rays an angle cross it, each to 1 /
    // 150^1.5.
    for (const int i : {128, 140, 165, 190}) CHECK(std::abs(relative(i, 137, 0.1)) < 1e-3);
    CHECK(std::abs(relative(100, 70, 0.1)) < 1e-3);
  }
}

TEST_CASE("rays counted one by one leave the same dose in the folds beyond the reach") {
  // Caustics: the light of one angle peaks like 1 / sqrt(distance), so a sum over angles is rough there; a voxel may be
  // off by some per cent, the mean of a row of voxels across the zone may not.
  for (const View& view : {vial, walled}) {
    VialSetup setup = setup_of(view, 1, 1, 720);
    setup.absorption_per_mm = 0.07;
    setup.grid = {28, 1, 1, 0.1, {8.7, 0.95, 0}};
    const Image dose = dose_of(setup, sinogram(setup, smooth_light));
    vam::oracle::RayDose slow = counted(setup);
    slow.rays = 8000;
    double sum = 0;
    double want_sum = 0;
    for (int i = 0; i < setup.grid.nx; i += 3) {
      // A disc of the voxel's variance.
      const double want =
          vam::oracle::ray_dose(slow, smooth_light, setup.grid.x_mm(i), setup.grid.y_mm(0), 0.1 / std::sqrt(3.0));
      CHECK(std::abs(dose(i, 0) / want - 1) < 0.02);
      sum += dose(i, 0);
      want_sum += want;
    }
    CHECK(std::abs(sum / want_sum - 1) < 2e-3);
  }
}

TEST_CASE("a coarse voxel holds the mean dose of its parts") {
  // Light in columns as fine as the projector shows: averaging, not picking, is what makes the two agree.
  const auto stripes = [](double x_p, double) { return std::fmod(std::floor(std::abs(x_p) / 0.065), 2.0); };
  const VialSetup coarse = setup_of(vial, 16, 8);
  const VialSetup fine = setup_of(vial, 160, 8);
  const Image whole = dose_of(coarse, sinogram(coarse, stripes));
  const Image parts = dose_of(fine, sinogram(fine, stripes));
  for (const auto [j, i] : indices(16, 16)) {
    double mean = 0;
    for (int k = 0; k < 100; ++k) mean += parts(10 * i + k % 10, 10 * j + k / 10) / 100;
    CHECK(whole(i, j) == doctest::Approx(mean).epsilon(0.005));
  }
}

TEST_CASE("direction and angle offset: the part turns, the dose turns with it") {
  VialSetup setup = setup_of(vial, 64, 14);
  const auto exact = [](double x_p, double theta) { return corrected(vial, x_p, theta); };
  const Image plain = dose_of(setup, sinogram(setup, exact));
  setup.direction = -1;
  setup.angle_offset_rad = 0.3;
  setup.turn.start_rad = 0.1;
  const Image same =
      dose_of(setup, sinogram(setup, [&](double x_p, double row_rad) { return exact(x_p, -(0.1 + row_rad) + 0.3); }));
  setup = setup_of(vial, 64, 14);
  setup.turn.step_rad = -setup.turn.step_rad;
  const Image backwards = dose_of(setup, sinogram(setup, exact));
  double most = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    most = std::max({most, static_cast<double>(std::abs(plain.values[i] - same.values[i])),
                     static_cast<double>(std::abs(plain.values[i] - backwards.values[i]))});
  }
  CHECK(most < 1e-3);  // other angles of the same turn: the rectangle rule over angles, and the table's steps
}

TEST_CASE("a projector narrower than the vial leaves the remainder dark") {
  VialSetup setup = setup_of(matched, 64, 24, 360, 101, 0.065);
  const Image dose = dose_of(setup, Image(101, 360, 1.0F));
  const double field = 0.5 * 101 * 0.065;
  CHECK(dose(32, 32) == doctest::Approx(turn_rad * chief_ray(matched, 0).transmittance).epsilon(1e-4));
  // A voxel at r is lit while |r cos b| is within the field.
  const double r = radius_of(setup.grid, 50, 32);
  const double lit = 4 * std::asin(field / r) * chief_ray(matched, 0).transmittance;
  CHECK(std::abs(dose(50, 32) - lit) < 4 * 0.5 * setup.turn.step_rad);  // four edges, each to half an angle step
}

TEST_CASE("slices do not depend on their neighbours or on the number of threads") {
  const VialSetup setup = setup_of(vial, 40, 20, 90);
  const VialOperator light(setup);
  const Image base = sinogram(setup, [](double x_p, double theta) { return corrected(vial, x_p, theta); });
  std::vector<Image> in(70, base);
  for (std::size_t k = 0; k < in.size(); ++k) {
    for (float& value : in[k].values) value *= static_cast<float>(k + 1);
  }
  const std::vector<Image> all = doses_of(light, in, in.size());
  set_threads(1);
  const std::vector<Image> one = doses_of(light, in, in.size());
  set_threads(0);
  for (std::size_t k = 0; k < in.size(); ++k) {
    CHECK(all[k].values == one[k].values);
    CHECK(all[k].values == doses_of(light, {&in[k], 1}, 1).front().values);
  }
}

TEST_CASE("a single voxel, on the axis or larger than the vial") {
  for (const double size : {0.1, 60.0}) {
    VialSetup setup = setup_of(matched, 1, size);
    CHECK(dose_of(setup, Image(440, 360, 1.0F))(0, 0) > 0);
  }
}

TEST_CASE("half a turn is refused") {
  VialSetup setup = setup_of(vial, 8, 8);
  setup.turn.step_rad /= 2;
  CHECK_THROWS_AS(VialOperator{setup}, Error);
}
