// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/shapes/private/cell_fraction.hpp"

#include <algorithm>
#include <cmath>

namespace vam::solid {

double cube_fraction(double offset, const Point& normal) {
  std::array<double, 3> m{std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])};
  std::sort(m.begin(), m.end());
  const double sum = m[0] + m[1] + m[2];
  const double level = 0.5 - offset / sum;  // share of the way from the first corner to the last
  if (level <= 0) return 0;
  if (level >= 1) return 1;
  const double a = std::min(level, 1 - level);
  const double m1 = std::max(m[0] / sum, 1e-7);  // floors against 0/0; they change the result by less than 1e-7
  const double m2 = std::max(m[1] / sum, 1e-7);
  const double m3 = m[2] / sum;
  const double m12 = m1 + m2;
  const auto cap = [a](double side) { return side * side * (side - 3 * a); };
  double volume = 0;
  if (a < m1) {
    volume = a * a * a / (6 * m1 * m2 * m3);
  } else if (a < m2) {
    volume = a * (a - m1) / (2 * m2 * m3) + m1 * m1 / (6 * m2 * m3);
  } else if (a < std::min(m12, m3)) {
    volume = (a * a * (3 * m12 - a) + cap(m1) + cap(m2)) / (6 * m1 * m2 * m3);
  } else if (m3 < m12) {
    volume = (a * a * (3 - 2 * a) + cap(m1) + cap(m2) + cap(m3)) / (6 * m1 * m2 * m3);
  } else {
    volume = (2 * a - m12) / (2 * m3);
  }
  volume = std::clamp(volume, 0.0, 0.5);
  return level <= 0.5 ? volume : 1 - volume;
}

namespace {

constexpr int deepest = 3;  // halvings of a voxel
// Departure from a linear field, relative to its change across the cell. Smooth curvature shows up as an even residual
// of at most a quarter of the curvature times the edge, which the mean value of the cell accounts for; edges show
// more, and an edge anywhere but in the middle has an odd part.
constexpr double even_least = 0.01;
constexpr double even_most = 0.04;
constexpr double odd_limit = 0.01;

// The field at a cell's corners as a plane and what is left.
struct Fit : Plane {
  double even = 0;  // largest residual that is the same at opposite corners, the cell's middle included
  double odd = 0;   // largest residual that changes its sign

  Fit(const CubeValues& corners, double middle) : Plane(corners) {
    CubeValues residual{};
    for (unsigned c = 0; c < 8; ++c) residual[c] = corners[c] - mean - dot(slope, corner_sign(c));
    even = std::abs(middle - mean);
    for (unsigned c = 0; c < 4; ++c) {
      even = std::max(even, 0.5 * std::abs(residual[c] + residual[7 - c]));
      odd = std::max(odd, 0.5 * std::abs(residual[c] - residual[7 - c]));
    }
  }
};

// Of the 3 x 3 x 3 nodes of a cell's eight parts, x fastest.
constexpr bool is_corner(unsigned n) { return n % 3 != 1 && n / 3 % 3 != 1 && n / 9 != 1; }
constexpr unsigned middle_node = 13;

// The mean over the cell's eight parts.
double halved_fraction(const Field& field, const Point& centre, double edge_mm, double middle,
                       const CubeValues& corners, int depth) {
  // What is not known yet: the other nodes, then the middles of the parts.
  std::array<Point, 27 - 8 - 1 + 8> points;
  auto* point = points.data();
  for (unsigned n = 0; n < 27; ++n) {
    if (is_corner(n) || n == middle_node) continue;
    const unsigned layer = n / 9;
    *point++ = centre + (edge_mm / 2) * Point{n % 3 - 1.0, n / 3 % 3 - 1.0, layer - 1.0};
  }
  for (unsigned part = 0; part < 8; ++part) *point++ = centre + (edge_mm / 2) * corner_sign(part);
  std::array<double, points.size()> values;
  values_at(field, points, values.data());

  LatticeValues<3> nodes;
  const double* value = values.data();
  for (unsigned n = 0; n < 27; ++n) {
    nodes.values[n] = is_corner(n)       ? corners[n % 3 / 2 + n / 3 % 3 / 2 * 2 + n / 9 / 2 * 4]
                      : n == middle_node ? middle
                                         : *value++;
  }
  double fraction = 0;
  for (int part = 0; part < 8; ++part) {
    const CubeValues part_corners = nodes.corners(part & 1, part >> 1 & 1, part >> 2);
    fraction += cell_fraction(field, centre + (edge_mm / 2) * corner_sign(part), edge_mm / 2, *value++, part_corners,
                              depth + 1) /
                8;
  }
  return fraction;
}

}  // namespace

double cell_fraction(const Field& field, const Point& centre, double edge_mm, double middle, const CubeValues& corners,
                     int depth) {
  if (std::abs(middle) > clear_mm(field, half_diagonal * edge_mm)) return middle < 0 ? 1 : 0;
  const Fit fit(corners, middle);
  const double steepness = length(fit.slope);
  const double even_limit = std::clamp(0.3 * field.curvature_per_mm * edge_mm, even_least, even_most);
  const bool smooth = fit.even <= even_limit * steepness && fit.odd <= odd_limit * steepness;
  if (!smooth && depth < deepest) return halved_fraction(field, centre, edge_mm, middle, corners, depth);
  if (!smooth) {
    // What an edge makes of a plane fitted to it must not cut corners that are all on one side.
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
    if (*high <= 0 && middle <= 0) return 1;
    if (*low >= 0 && middle >= 0) return 0;
  }
  if (steepness == 0) return middle < 0 ? 1 : 0;
  return fit.fraction(middle);
}

}  // namespace vam::solid
