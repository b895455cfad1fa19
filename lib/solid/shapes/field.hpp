// SPDX-License-Identifier: GPL-3.0-or-later
// Solids given by a function: negative inside. What the parametric test parts are made of.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "model/grid.hpp"
#include "solid/mesh/geometry.hpp"

namespace vam::solid {

/// A solid { p : value(p) < 0 }, p in mm.
struct Field {
  /// At up to so many points. See values_at().
  static constexpr std::size_t together = 32;
  std::function<void(std::span<const Point> points, double* values)> some;
  [[nodiscard]] double value(const Point& p) const {
    double one = 0;
    some({&p, 1}, &one);
    return one;
  }
  /// |value(p)| <= lipschitz * (distance from p to the surface), so a large value proves a ball free of surface.
  double lipschitz = 1;
  /// Largest curvature of the smooth parts of the surface, 1/mm: tells roundness from edges within a voxel.
  double curvature_per_mm = 0;
  Bounds box;            // holds the solid, tight
  double radius_mm = 0;  // of the smallest cylinder about the z axis that holds the solid
  double ball_mm = 0;    // of the smallest ball about box.centre() that holds the solid

  /// Upper bound of the extent of the solid in the direction d (a unit vector): max of dot(d, p). Tight for boxes,
  /// upright cylinders and balls.
  [[nodiscard]] double support_mm(const Point& d) const;
};

/// Field::some of a function of one point.
template <class Value>
[[nodiscard]] auto point_by_point(Value value) {
  return [value = std::move(value)](std::span<const Point> points, double* values) {
    std::transform(points.begin(), points.end(), values, value);
  };
}

/// The field at every point, mm.
void values_at(const Field& field, std::span<const Point> points, double* values);

/// The solid moved by a map. Bounds, radius and ball stay bounds, tight where support_mm() is.
[[nodiscard]] Field transformed(const Field& field, const Affine& map);

/// Fraction of the unit cube centred at the origin where offset + dot(normal, x) < 0; normal of any length but 0
/// [SZ00 eq 3; physics §13.1].
[[nodiscard]] double cube_fraction(double offset, const Point& normal);

/// Fractional coverage, 0...1, of the voxels of slices k0 .. k0 + count - 1: out[((k - k0) * ny + j) * nx + i]. A voxel
/// in which the field is linear to 2 % is cut by a plane; others are halved, down to an eighth of a voxel. Void is
/// exactly 0 and interior exactly 1.
void cover(const Field& field, const model::Grid& grid, int k0, int count, float* out);

}  // namespace vam::solid
