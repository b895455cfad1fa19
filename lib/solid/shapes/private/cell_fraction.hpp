// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a cubic cell that a solid fills, from the field at its corners and its middle.
#pragma once

#include <array>

#include "solid/shapes/field.hpp"

namespace vam::solid {

/// Corner c of a cell: bit a of c tells the side along axis a.
using CubeValues = std::array<double, 8>;

/// From the middle of a cell to its corner c, in edges.
inline Point corner_sign(unsigned c) {
  return {(c & 1U) != 0 ? 0.5 : -0.5, (c & 2U) != 0 ? 0.5 : -0.5, (c & 4U) != 0 ? 0.5 : -0.5};
}

inline constexpr double half_diagonal = 0.8660254037844386;  // of a unit cube

/// A field of more than this, or less than its negative, in the middle of a ball: the surface is clear of it.
/// Numerically projected distances (gyroid) are Lipschitz to a few per cent.
inline double clear_mm(const Field& field, double radius_mm) { return 1.05 * field.lipschitz * radius_mm; }

/// A cell in which the field is linear to 2 % is cut by a plane; others are halved, `depth` counting how often, down to
/// an eighth of a voxel.
[[nodiscard]] double cell_fraction(const Field& field, const Point& centre, double edge_mm, double middle,
                                   const CubeValues& corners, int depth = 0);

}  // namespace vam::solid
