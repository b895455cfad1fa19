// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a cubic cell that a solid fills, from the field at its corners and its middle.
#pragma once

#include <array>
#include <cstddef>

#include "solid/shapes/field.hpp"

namespace vam::solid {

/// Corner c of a cell: bit a of c tells the side along axis a.
using CubeValues = std::array<double, 8>;

/// From the middle of a cell to its corner c, in edges.
inline Point corner_sign(unsigned c) {
  return {(c & 1U) != 0 ? 0.5 : -0.5, (c & 2U) != 0 ? 0.5 : -0.5, (c & 4U) != 0 ? 0.5 : -0.5};
}

/// side^3 values of a field, x fastest.
template <std::size_t side>
struct LatticeValues {
  std::array<double, side * side * side> values;

  LatticeValues() = default;
  /// At origin + step_mm * (first + i, first + j, first + k).
  LatticeValues(const Field& field, const Point& origin, double first, double step_mm) {
    std::array<Point, side * side * side> points;
    auto* point = points.data();
    for (std::size_t k = 0; k < side; ++k) {
      for (std::size_t j = 0; j < side; ++j) {
        for (std::size_t i = 0; i < side; ++i) {
          *point++ = origin + step_mm * Point{first + static_cast<double>(i), first + static_cast<double>(j),
                                              first + static_cast<double>(k)};
        }
      }
    }
    values_at(field, points, values.data());
  }
  [[nodiscard]] double operator()(int i, int j, int k) const { return values[(k * side + j) * side + i]; }
  /// Of the cell between that value and the next ones.
  [[nodiscard]] CubeValues corners(int i, int j, int k) const {
    CubeValues corners{};
    for (int c = 0; c < 8; ++c) corners[c] = (*this)(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
    return corners;
  }
};

/// The plane nearest to a field at the corners of a cell.
struct Plane {
  double mean = 0;
  Point slope{};  // change of the field across the cell along each axis

  explicit Plane(const CubeValues& corners) {
    for (unsigned c = 0; c < 8; ++c) {
      mean += corners[c] / 8;
      slope = slope + (corners[c] / 2) * corner_sign(c);
    }
  }
  /// Of the cell, by the mean over it of a field that is quadratic: two thirds its value in the middle, one third at
  /// the corners.
  [[nodiscard]] double fraction(double middle) const { return cube_fraction((2 * middle + mean) / 3, slope); }
};

inline constexpr double half_diagonal = 0.8660254037844386;  // of a unit cube

/// A field of more than this, or less than its negative, in the middle of a ball: the surface is clear of it.
/// Numerically projected distances (gyroid) are Lipschitz to a few per cent.
inline double clear_mm(const Field& field, double radius_mm) { return 1.05 * field.lipschitz * radius_mm; }

/// A cell in which the field is linear to 2 % is cut by a plane; others are halved, `depth` counting how often, down to
/// an eighth of a voxel.
[[nodiscard]] double cell_fraction(const Field& field, const Point& centre, double edge_mm, double middle,
                                   const CubeValues& corners, int depth = 0);

}  // namespace vam::solid
