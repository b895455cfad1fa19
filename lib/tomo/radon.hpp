// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel-beam projection A and its exact adjoint A* on slabs of 16 slices, by separable trapezoid footprints
// [LF10; physics §1]: pixel (i, j) spreads over the at most three detector bins that its shadow covers, with weights
// that add up to 1 in both directions.
#pragma once

#include <span>

#include "base/compute/simd.hpp"
#include "base/compute/slab.hpp"

namespace vam::tomo {

/// Object nx x ny pixels, detector bins as wide as a pixel. The axis is at pixel coordinate (axis_x, axis_y) and at
/// column (columns - 1) / 2. Angle a is angle_start_rad + a * angle_step_rad. t = x cos + y sin, u = -x sin + y cos
/// [CAL17 eq 1], in pixels.
struct ParallelGeometry {
  int nx = 0;
  int ny = 0;
  int columns = 0;
  int angles = 0;
  double axis_x = 0;
  double axis_y = 0;
  double angle_start_rad = 0;
  double angle_step_rad = 0;
  double alpha_per_px = 0;  // exponential Radon transform: weight e^{alpha u} [CAL19 eq 3]; 0 = plain

  [[nodiscard]] ParallelGeometry with_alpha(double alpha) const {
    ParallelGeometry other = *this;
    other.alpha_per_px = alpha;
    return other;
  }
};

/// sinogram(t, a) = sum over pixels of w(pixel, t, a) * image(pixel) * e^{alpha u}. Multiply by the voxel size to get
/// line integrals. All slabs of one call must have the shape of the geometry; several slabs a call share the weights.
void forward(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<Slab> sinograms,
             Simd level = simd_level());

/// image(pixel) = sum over angles and bins of w(pixel, t, a) * sinogram(t, a) * e^{alpha u}: the transpose of forward.
/// Multiply by the angle step to get the dose integral [physics §4]; dose in an absorber has alpha = -mu.
void adjoint(const ParallelGeometry& geometry, std::span<const Slab> sinograms, std::span<Slab> images,
             Simd level = simd_level());

}  // namespace vam::tomo
