// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/calibration_scans.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/ray_tracer.hpp"

namespace vam::oracle {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int nodes = 600;   // from either edge to the axis
constexpr int views = 2000;  // lines of sight of the camera

double noisy(double value, double read_noise, double electrons, Random& random) {
  std::normal_distribution<double> unit;
  return value + std::sqrt(read_noise * read_noise + std::max(value, 0.0) / electrons) * unit(random);
}

struct Plane {
  double x = 0, y = 0;
};
double dot(Plane a, Plane b) { return a.x * b.x + a.y * b.y; }
double cross(Plane a, Plane b) { return a.x * b.y - a.y * b.x; }

// A ray in the resin, from where it enters it.
struct Path {
  Plane from, direction;
  double length = 0, light = 0;
};

Path path_of(const Ray& ray, double turn_rad) {
  const double c = std::cos(turn_rad);
  const double s = std::sin(turn_rad);
  const auto turned = [&](const Vec& v) {
    const auto x = static_cast<double>(v[0]);
    const auto y = static_cast<double>(v[1]);
    return Plane{c * x - s * y, s * x + c * y};
  };
  Path path{turned(ray.point), turned(ray.direction), 0, static_cast<double>(ray.transmittance)};
  path.length = -2 * dot(path.from, path.direction);
  return path;
}

double outermost_mm(const Bench& bench, double radius_mm) {
  double low = 0;
  double high = 2 * radius_mm;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (trace(bench, middle) ? low : high) = middle;
  }
  return low;
}

std::vector<Path> sights_of(const Bench& bench, double edge_mm, double turn_rad) {
  std::vector<Path> paths;
  for (int i = 0; i < views; ++i) {
    const double angle = pi * (i + 0.5) / views;
    paths.push_back(path_of(*trace(bench, -edge_mm * std::cos(angle)), turn_rad));
    paths.back().light *= edge_mm * std::sin(angle) * pi / views;
  }
  return paths;
}

// Of a sheet of light, on all lines of sight: each sees it where they cross, if that is in the resin, as bright as what
// is left of it on its way from where it enters.
double seen(const Path& sheet, const std::vector<Path>& sights, double absorption_per_mm) {
  double sum = 0;
  for (const Path& sight : sights) {
    const Plane between{sight.from.x - sheet.from.x, sight.from.y - sheet.from.y};
    const double slant = cross(sheet.direction, sight.direction);
    const double along = cross(between, sight.direction) / slant;
    const double deep = cross(between, sheet.direction) / slant;
    if (along > 0 && along < sheet.length && deep > 0 && deep < sight.length)
      sum += sight.light / std::abs(slant) * std::exp(-absorption_per_mm * along);
  }
  return sheet.light * sum;
}

}  // namespace

SweepBench::SweepBench(const SweepTruth& truth) : truth_(truth) {
  Bench bench;
  if (truth.wall_mm > 0) bench.cylinders.push_back({truth.radius_mm, truth.glass_index});
  const double inner_mm = truth.radius_mm - truth.wall_mm;
  bench.cylinders.push_back({inner_mm, truth.resin_index});
  bench.lens_distance = truth.camera_mm;
  const auto sights = sights_of(bench, outermost_mm(bench, truth.radius_mm), truth.camera_rad);
  bench.lens_distance.reset();
  if (truth.lens_mm) bench.lens_distance = *truth.lens_mm;
  edge_mm_ = outermost_mm(bench, truth.radius_mm);
  for (int i = 0; i <= nodes; ++i) {
    const double root = static_cast<double>(i) / nodes;
    for (const int side : {0, 1}) {
      const double x_mm = (side == 0 ? -1 : 1) * edge_mm_ * (1 - root * root);
      table_[side].push_back(seen(path_of(*trace(bench, x_mm), 0), sights, truth.absorption_per_mm) / (2 * inner_mm));
    }
  }
}

double SweepBench::fluorescence(double x_px) const {
  const double x_mm = x_px * truth_.pixel_mm;
  if (std::abs(x_mm) >= edge_mm_) return 0;
  const double place = std::sqrt(1 - std::abs(x_mm) / edge_mm_) * nodes;
  const auto i = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(nodes - 1));
  const double part = place - static_cast<double>(i);
  // Whatever else changes with the turn of a sheet: asin(b / R) - asin(b / n R), b the distance of its ray from the
  // axis.
  const double tangent = truth_.lens_mm ? x_mm / *truth_.lens_mm : 0;
  const double b = std::clamp(x_mm / std::hypot(1, tangent) / truth_.radius_mm, -1.0, 1.0);
  const double gain = 1 + truth_.slope * (std::asin(b) - std::asin(b / truth_.resin_index));
  const auto& table = table_[x_mm > 0 ? 1 : 0];
  return gain * ((1 - part) * table[i] + part * table[i + 1]);
}

Image SweepBench::frame(double line_column, double width_px, const std::vector<double>& height_mm, int columns,
                        Random& random) const {
  Image image(columns, static_cast<int>(height_mm.size()));
  for (int row = 0; row < image.height; ++row) {
    const double axis = truth_.axis_column + std::tan(truth_.tilt_rad) * height_mm[row] / truth_.pixel_mm;
    double light = 0;
    double weights = 0;
    for (int g = -6; g <= 6; ++g) {  // the blur
      const double z = g / 2.0;
      for (int k = 0; k < 6; ++k) {  // across the line
        const double x = line_column - axis + truth_.blur_px * z + width_px * ((k + 0.5) / 6 - 0.5);
        light += std::exp(-z * z / 2) * fluorescence(x);
        weights += std::exp(-z * z / 2);
      }
    }
    light *= 100 / weights;
    for (int x = 0; x < columns; ++x)
      image(x, row) = static_cast<float>(noisy(20 + light, truth_.noise, truth_.electrons, random));
  }
  return image;
}

Image bright_band(const BandTruth& truth, Random& random) {
  Image image(truth.columns, truth.rows);
  for (int y = 0; y < truth.rows; ++y) {
    const double middle = truth.middle + truth.lean * (y - 0.5 * (truth.rows - 1));
    for (int x = 0; x < truth.columns; ++x) {
      const auto edge = [&](double at) { return 0.5 * std::erfc((at - x) / truth.blur_px / std::sqrt(2.0)); };
      const double part = edge(middle - truth.half_width) - edge(middle + truth.half_width);
      image(x, y) = static_cast<float>(noisy(truth.ground + truth.light * part, truth.noise, 10, random));
    }
  }
  return image;
}

}  // namespace vam::oracle
