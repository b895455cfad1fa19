// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/sheet_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "oracle/ray_tracer.hpp"

namespace vam::oracle {

namespace {

using Point = std::array<double, 2>;

// A ray in resin, in the plane of the projector's lens.
struct Path {
  Point entry;
  Point direction;  // unit vector
  double transmittance;
  double rise;  // height of a ray that would pass the axis at height 1: at the entry, and per mm after it
  double slope;
};

double along(const Path& path, const Point& p) {
  return (p[0] - path.entry[0]) * path.direction[0] + (p[1] - path.entry[1]) * path.direction[1];
}
// Distance to the left of the path.
double beside(const Path& path, const Point& p) {
  return (p[1] - path.entry[1]) * path.direction[0] - (p[0] - path.entry[0]) * path.direction[1];
}
Point at(const Path& path, double mm) {
  return {path.entry[0] + mm * path.direction[0], path.entry[1] + mm * path.direction[1]};
}

Bench vial_of(const SheetBench& bench, const std::optional<double>& lens_mm) {
  Bench vial;
  if (lens_mm) vial.lens_distance = *lens_mm;
  vial.cylinders = {{bench.radius_mm, bench.wall_mm > 0 ? bench.glass_index : bench.resin_index}};
  if (bench.wall_mm > 0) vial.cylinders.push_back({bench.radius_mm - bench.wall_mm, bench.resin_index});
  return vial;
}

// The ray through (x, 0) of a lens that is turned around the axis.
std::optional<Path> path_of(const Bench& vial, double x, double turned_rad) {
  const auto level = trace(vial, x);
  constexpr Real height = 1e-4L;  // small against every distance, large against the digits of Real
  const auto risen = trace(vial, x, height);
  if (!level || !risen) return std::nullopt;
  const Real c = std::cos(static_cast<Real>(turned_rad));
  const Real s = std::sin(static_cast<Real>(turned_rad));
  const auto turned = [&](const Vec& v) {
    return Point{static_cast<double>(c * v[0] - s * v[1]), static_cast<double>(s * v[0] + c * v[1])};
  };
  const Real level_part = std::hypot(risen->direction[0], risen->direction[1]);
  return Path{turned(level->point), turned(level->direction), static_cast<double>(level->transmittance),
              static_cast<double>(risen->point[2] / height),
              static_cast<double>(risen->direction[2] / level_part / height)};
}

// The largest x whose ray enters, to the last bit of a double.
double outermost(const Bench& vial, double radius_mm) {
  double in = 0;
  double out = 2 * radius_mm;
  for (int i = 0; i < 100; ++i) {
    const double middle = (in + out) / 2;
    (trace(vial, middle) ? in : out) = middle;
  }
  return in;
}

// count + 1 values from -x to x, denser towards both ends.
std::vector<double> spread_over(double x, int count) {
  std::vector<double> values;
  for (int i = 0; i <= count; ++i) values.push_back(-x * std::cos(std::numbers::pi * i / count));
  return values;
}

// Where a line of sight lies between two rays and in the resin, in mm from its entry; empty if nowhere.
std::optional<std::pair<double, double>> between(const Path& first, const Path& second, const Path& sight,
                                                 double length_mm) {
  const auto crossing = [&](const Path& ray) {
    const double sine = ray.direction[0] * sight.direction[1] - ray.direction[1] * sight.direction[0];
    return -beside(ray, sight.entry) / sine;
  };
  const auto [near, far] = std::minmax({crossing(first), crossing(second)});
  const double begin = std::max(near, 0.0);
  const double end = std::min(far, length_mm);
  if (!(begin < end)) return std::nullopt;
  return std::pair{begin, end};
}

// Brightness of a strip along a line of sight: power over width, times what absorption has left, times the length.
double gathered(const SheetBench& bench, const Path& first, const Path& second, const Path& sight) {
  const double length_mm = -2 * (sight.entry[0] * sight.direction[0] + sight.entry[1] * sight.direction[1]);
  const auto inside = between(first, second, sight, length_mm);
  if (!inside) return 0;
  const double middle_mm = (inside->first + inside->second) / 2;
  const Point p = at(sight, middle_mm);
  const double width_mm = std::abs(beside(first, p)) + std::abs(beside(second, p));
  const double path_mm = (along(first, p) + along(second, p)) / 2;
  const double height = bench.rows_spread ? first.rise + first.slope * path_mm : 1;
  const double left = std::exp(-bench.absorption_per_mm * path_mm - bench.seen_absorption_per_mm * middle_mm);
  return left * (inside->second - inside->first) / (width_mm * height);
}

}  // namespace

std::vector<SeenStrip> seen_strips(const SheetBench& bench) {
  const Bench lit = vial_of(bench, bench.lens_mm);
  const Bench viewed = vial_of(bench, bench.camera_mm);
  const auto columns = spread_over(outermost(viewed, bench.radius_mm), bench.sights);
  std::vector<std::pair<Path, double>> sights;  // with the camera's width times what leaves the vial
  for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
    const auto sight = path_of(viewed, (columns[i] + columns[i + 1]) / 2, bench.camera_rad);
    if (sight) sights.emplace_back(*sight, (columns[i + 1] - columns[i]) * sight->transmittance);
  }
  const auto edges = spread_over(outermost(lit, bench.radius_mm), bench.strips);
  std::vector<SeenStrip> strips;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const auto first = path_of(lit, edges[i], 0);
    const auto second = path_of(lit, edges[i + 1], 0);
    if (!first || !second) continue;
    const double width_mm = edges[i + 1] - edges[i];
    const double power = width_mm * (first->transmittance + second->transmittance) / 2;
    double seen = 0;
    for (const auto& [sight, weight] : sights) seen += weight * power * gathered(bench, *first, *second, sight);
    strips.push_back({(edges[i] + edges[i + 1]) / 2, width_mm, seen / width_mm});
  }
  return strips;
}

double seen_line(const std::vector<SeenStrip>& strips, double x_mm, double width_mm, double sigma_mm) {
  double sum = 0;
  for (const SeenStrip& strip : strips) {
    const auto below = [&](double edge) {
      return std::erf((strip.x_mm - x_mm - edge) / (sigma_mm * std::numbers::sqrt2)) / 2;
    };
    sum += strip.seen * strip.width_mm * (below(-width_mm / 2) - below(width_mm / 2)) / width_mm;
  }
  return sum;
}

}  // namespace vam::oracle
