// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/shapes/field.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace vam::solid {

double Field::support_mm(const Point& d) const {
  const Point centre = box.centre();
  const Point half = 0.5 * box.size();
  const double by_box = dot(d, centre) + std::abs(d[0]) * half[0] + std::abs(d[1]) * half[1] + std::abs(d[2]) * half[2];
  const double by_cylinder = std::hypot(d[0], d[1]) * radius_mm + d[2] * centre[2] + std::abs(d[2]) * half[2];
  const double by_ball = dot(d, centre) + ball_mm;
  return std::min({by_box, by_cylinder, by_ball});
}

void values_at(const Field& field, std::span<const Point> points, double* values) {
  for (std::size_t at = 0; at < points.size(); at += Field::together) {
    field.some(points.subspan(at, std::min(Field::together, points.size() - at)), values + at);
  }
}

namespace {

// Largest stretch of a linear map. The Frobenius norm bounds the spectral one; for a rotation with one scale it is
// sqrt(3) too large, so the largest row of m m^T is used (Gershgorin), which is exact there.
double largest_stretch(const Affine& map) {
  double squared = 0;
  for (const Point& row : map.linear) {
    double sum = 0;
    for (const Point& other : map.linear) sum += std::abs(dot(row, other));
    squared = std::max(squared, sum);
  }
  return std::sqrt(squared);
}

}  // namespace

Field transformed(const Field& field, const Affine& map) {
  const Affine back = inverse(map);
  // Support of the image in direction d: support of the original along the transposed map of d.
  const auto support = [&](const Point& d) {
    const auto& m = map.linear;
    const Point pulled = d[0] * m[0] + d[1] * m[1] + d[2] * m[2];
    const double norm = length(pulled);
    return norm * field.support_mm((1 / norm) * pulled) + dot(d, map.shift);
  };
  const double steeper = largest_stretch(back);
  Field result;
  result.lipschitz = field.lipschitz * steeper;
  result.curvature_per_mm = field.curvature_per_mm * steeper;
  for (std::size_t a = 0; a < 3; ++a) {
    Point d{};
    d[a] = 1;
    result.box.high[a] = support(d);
    d[a] = -1;
    result.box.low[a] = -support(d);
  }
  constexpr int directions = 720;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2 * std::numbers::pi * i / directions;
    result.radius_mm = std::max(result.radius_mm, support({std::cos(angle), std::sin(angle), 0}));
  }
  // A corner between two sampled directions sticks out by less than 1 - cos(pi / 720).
  result.radius_mm /= std::cos(std::numbers::pi / directions);
  double stretch = 0;
  for (const Point& row : map.linear) stretch = std::max(stretch, length(row));
  result.ball_mm = std::min(0.5 * result.box.diagonal(),
                            stretch * field.ball_mm + length(map(field.box.centre()) - result.box.centre()));
  result.some = [inner = field.some, back](std::span<const Point> points, double* values) {
    std::array<Point, Field::together> before;
    std::transform(points.begin(), points.end(), before.begin(), back);
    inner(std::span(before).first(points.size()), values);
  };
  return result;
}

}  // namespace vam::solid
