// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage where the surface is smooth on the scale of several voxels: a quadratic instead of a value per corner.
#pragma once

#include <array>
#include <cstddef>

#include "solid/shapes/field.hpp"

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
  void interpolate();
  [[nodiscard]] bool is_quadratic() const;
  [[nodiscard]] double corner(int i, int j, int k) const { return corners_[index<side + 1>(i, j, k)]; }

  static constexpr std::size_t cubed(std::size_t n) { return n * n * n; }
  template <int edge>
  static std::size_t index(int i, int j, int k) {
    return (static_cast<std::size_t>(k) * edge + j) * edge + i;
  }

  double clear_mm_;
  double steepness_ = 0;  // mm per voxel, in the middle
  bool holds_ = false;
  std::array<double, 27> nodes_{};
  std::array<double, cubed(side + 1)> corners_;  // of the voxels
  std::array<double, cubed(side)> centres_;
};

}  // namespace vam::solid
