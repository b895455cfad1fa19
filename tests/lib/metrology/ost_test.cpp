// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/ost.hpp"

#include "base/constants.hpp"
#include "base/vector3.hpp"
#include "lib/metrology/synthetic_views.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

constexpr double sphere_radius_mm = 3;
constexpr Vector3 sphere_centre_mm{1.5, -0.8, 0.5};

double ball(double x, double y, double z) {
  const double r = length(Vector3{x, y, z} - sphere_centre_mm);
  return std::clamp((sphere_radius_mm - r) / 0.1 + 0.5, 0.0, 1.0);  // a surface 0.1 mm thick
}

float value_at(const model::Volume& volume, const Vector3& p) {
  const auto& g = volume.grid;
  const double f[3] = {(p[0] - g.origin_mm[0]) / g.voxel_mm, (p[1] - g.origin_mm[1]) / g.voxel_mm,
                       (p[2] - g.origin_mm[2]) / g.voxel_mm};
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int index[3];
    for (int d = 0; d < 3; ++d) {
      const double low = std::floor(f[d]);
      const bool high = (corner >> d & 1) != 0;
      index[d] = static_cast<int>(low) + (high ? 1 : 0);
      weight *= high ? f[d] - low : 1 - (f[d] - low);
    }
    if (index[0] < 0 || index[1] < 0 || index[2] < 0 || index[0] >= g.nx || index[1] >= g.ny || index[2] >= g.nz)
      continue;
    sum += static_cast<float>(weight) * volume.slice(index[2])[index[1] * g.nx + index[0]];
  }
  return sum;
}

// RMS over directions of the distance at which the density falls through half, against the true radius.
double surface_rms_mm(const model::Volume& volume) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 200; ++i) {
    const double z = -1 + (2 * i + 1) / 200.0;  // spread evenly on the sphere: Fibonacci
    const double phi = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Vector3 direction{std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
    double edge = 0;
    for (double r = 1.5; r < 6; r += 0.01) {
      if (value_at(volume, sphere_centre_mm + r * direction) < 0.5F) {
        edge = r;
        break;
      }
    }
    sum += (edge - sphere_radius_mm) * (edge - sphere_radius_mm);
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("a sphere imaged through glass and resin, with noise and binning, is reconstructed within 1 % of its size") {
  const model::Printer printer = test::glass_rig();
  const double pixel_mm = 0.04;
  const auto camera = test::camera_bench(printer, 400, 192, pixel_mm);
  const auto views = test::take_views(camera, ball, test::even_angles(60), 0.05, 4,
                                      {.reach_mm = 5});  // noise 1 % of the brightest pixel
  OstOptions options;
  const AxisEstimate axis = find_axis(mean_view(views));
  CHECK(std::abs(axis.pose.column - 0.5 * 99) < 0.1);
  const OstReconstructor reconstructor(printer, 4 * pixel_mm, 100, 48, axis.pose, options);
  const double rms = surface_rms_mm(reconstructor.reconstruct(views));
  CHECK(rms < 0.06);  // the bars: a voxel is 0.16 mm, 1 % of the diameter is 0.06 mm
  options.refraction = false;
  const OstReconstructor naive(printer, 4 * pixel_mm, 100, 48, axis.pose, options);
  const double naive_rms = surface_rms_mm(naive.reconstruct(views));
  MESSAGE("surface RMS ", rms, " mm; without refraction ", naive_rms, " mm");
  CHECK(naive_rms > 3 * rms);
}

TEST_CASE("missing, repeated and jittered frames with true stamps cost at most a fifth") {
  const model::Printer printer = test::glass_rig();
  const auto camera = test::camera_bench(printer, 128, 64, 0.16);
  std::vector<double> uneven;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 180; ++i) {
    if (unit(random) < 0.1) continue;
    uneven.push_back(2.0 * i + unit(random) - 0.5);
    if (unit(random) < 0.05) uneven.push_back(uneven.back());
  }
  const AxisPose axis{0.5 * 127, 0};
  const OstReconstructor reconstructor(printer, 0.16, 128, 64, axis, {});
  const double even =
      surface_rms_mm(reconstructor.reconstruct(test::take_views(camera, ball, test::even_angles(180), 0.05, 1)));
  const double rms = surface_rms_mm(reconstructor.reconstruct(test::take_views(camera, ball, uneven, 0.05, 1)));
  MESSAGE("surface RMS ", rms, " mm; with even frames ", even, " mm");
  CHECK(rms < 1.2 * even);
}

TEST_CASE("axis offset of 3.7 px and tilt of 0.5 deg are found in traced views within 0.1 px and 0.05 deg") {
  auto camera = test::camera_bench(test::glass_rig(), 256, 96, 0.1);
  camera.axis_column += 3.7;
  camera.tilt_rad = 0.5 * rad_per_deg;
  const auto views = test::take_views(camera, ball, test::even_angles(60), 0.1, 1);  // 2 % of the brightest
  const AxisEstimate found = find_axis(mean_view(views));
  MESSAGE("column off by ", found.pose.column - camera.axis_column, " +- ", found.column_sigma, " px, tilt by ",
          found.pose.tilt_rad * deg_per_rad - 0.5, " +- ", found.tilt_sigma_rad * deg_per_rad, " deg");
  CHECK(std::abs(found.pose.column - camera.axis_column) < 0.1);
  CHECK(std::abs(found.pose.tilt_rad * deg_per_rad - 0.5) < 0.05);
}

TEST_CASE("the volume is as high as the rows, and z = 0 is at the row of the lens, by default the middle one") {
  const model::Printer printer = test::glass_rig();
  // A row is as high as seen from the lens: glass of 1 mm and resin of 11.7 bring the axis nearer.
  const double row_mm = 0.16 * (200 - 12.7 + 1 / 1.52 + 11.7 / 1.5) / 200;
  const auto middle_mm = [&](std::optional<double> axis_row) {
    OstOptions options{.axis_row = axis_row};
    const model::Grid grid = OstReconstructor(printer, 0.16, 128, 64, {0.5 * 127, 0}, options).grid();
    CHECK(grid.nz == static_cast<int>(64 * row_mm / 0.16));
    return grid.z_mm(0.5 * (grid.nz - 1));
  };
  CHECK(middle_mm(std::nullopt) == doctest::Approx(0));
  CHECK(middle_mm(20) == doctest::Approx(row_mm * (20 - 31.5)));
}
