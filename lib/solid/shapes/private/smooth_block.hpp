// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage where the surface is smooth on the scale of several voxels: a quadratic instead of a value per corner.
#pragma once

#include "solid/shapes/private/cell_fraction.hpp"

namespace vam::solid {

/// The field in a block of side^3 voxels by tensor-product quadratics through 27 values. It holds where the field
/// follows a polynomial of total degree 2 to 5 % of its change across a voxel at the block's corners, and the
/// quadratics to 0.5 % at eight points between the nodes; an edge of the solid shows in one or the other.
template <int side>
class SmoothBlock {
 public:
  SmoothBlock(const Field& field, const Point& middle, double voxel_mm);

  [[nodiscard]] bool holds() const { return holds_; }
  /// Fraction, 0...1, of the i, j, k-th voxel of the block. Only where it holds.
  [[nodiscard]] double fraction(int i, int j, int k) const;

 private:
  [[nodiscard]] bool is_quadratic() const;

  double clear_mm_;
  double steepness_ = 0;  // mm per voxel, in the middle
  bool holds_ = false;
  LatticeValues<3> nodes_;
  LatticeValues<side + 1> corners_;  // of the voxels
  LatticeValues<side> centres_;
};

}  // namespace vam::solid
