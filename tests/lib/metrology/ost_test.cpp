#include "metrology/ost.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/parallel.hpp"
#include "base/vector3.hpp"
#include "oracle/camera_views.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

constexpr double sphere_radius_mm = 3;
constexpr Vector3 sphere_centre_mm{1.5, -0.8, 0.5};

double ball(double x, double y, double z) {
  const double r = length(Vector3{x, y, z} - sphere_centre_mm);
  return std::clamp((sphere_radius_mm - r) / 0.1 + 0.5, 0.0, 1.0);  // a surface 0.1 mm thick
}

model::Printer rig() {
  model::Printer printer;
  printer.vial = {.radius_mm = 12.7, .wall_mm = 1, .index_glass = 1.52};
  printer.camera.distance_mm = 200;
  printer.camera.index_resin = 1.50;
  printer.camera.azimuth_deg = 90;
  return printer;
}

oracle::CameraBench bench(const model::Printer& printer, int columns, int rows, double pixel_mm) {
  oracle::CameraBench camera;
  camera.bench.lens_distance = printer.camera.distance_mm;
  camera.bench.bath = 1;
  camera.bench.cylinders = {{printer.vial.radius_mm, printer.vial.index_glass},
                            {printer.vial.radius_mm - printer.vial.wall_mm, printer.camera.index_resin}};
  camera.columns = columns;
  camera.rows = rows;
  camera.pixel_mm = pixel_mm;
  camera.axis_column = 0.5 * (columns - 1);
  camera.azimuth_deg = printer.camera.azimuth_deg;
  return camera;
}

std::vector<View> take_views(const oracle::CameraBench& camera, const oracle::Density& density,
                             const std::vector<double>& angles_deg, double noise, int binning) {
  const oracle::Camera eye(camera, 0.1, 7);
  std::vector<View> views(angles_deg.size());
  parallel_for(static_cast<int>(views.size()), [&](int i) {
    Image raw(camera.columns, camera.rows);
    raw.values = eye.view(density, angles_deg[static_cast<std::size_t>(i)]);
    std::mt19937 random(static_cast<unsigned>(i) + 1);
    std::normal_distribution<float> normal(0, static_cast<float>(noise));
    if (noise > 0) {
      for (float& value : raw.values) value += normal(random);
    }
    views[static_cast<std::size_t>(i)] = {corrected(raw, {}, binning, "view"), angles_deg[static_cast<std::size_t>(i)]};
  });
  return views;
}

std::vector<double> even_angles(int count) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(360.0 * i / count);
  return angles;
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

TEST_CASE("a sphere seen through glass and resin, with noise and binning, comes back within 1 % of its size") {
  const model::Printer printer = rig();
  const double pixel_mm = 0.08;
  const auto camera = bench(printer, 256, 128, pixel_mm);
  const auto views = take_views(camera, ball, even_angles(120), 0.05, 2);  // noise 1 % of the brightest pixel
  OstOptions options;
  const AxisEstimate axis = find_axis(mean_view(views));
  CHECK(std::abs(axis.pose.column - 0.5 * 127) < 0.1);
  const OstReconstructor reconstructor(printer, 2 * pixel_mm, 128, 64, axis.pose, options);
  const double rms = surface_rms_mm(reconstructor.reconstruct(views));
  CHECK(rms < 0.06);  // the bars: a voxel is 0.16 mm, 1 % of the diameter is 0.06 mm
  options.refraction = false;
  const OstReconstructor naive(printer, 2 * pixel_mm, 128, 64, axis.pose, options);
  const double naive_rms = surface_rms_mm(naive.reconstruct(views));
  MESSAGE("surface RMS ", rms, " mm; without refraction ", naive_rms, " mm");
  CHECK(naive_rms > 3 * rms);
}

TEST_CASE("missing, repeated and jittered frames with true stamps cost at most a fifth") {
  const model::Printer printer = rig();
  const auto camera = bench(printer, 128, 64, 0.16);
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
  const double even = surface_rms_mm(reconstructor.reconstruct(take_views(camera, ball, even_angles(180), 0.05, 1)));
  const double rms = surface_rms_mm(reconstructor.reconstruct(take_views(camera, ball, uneven, 0.05, 1)));
  MESSAGE("surface RMS ", rms, " mm; with even frames ", even, " mm");
  CHECK(rms < 1.2 * even);
}
