// SPDX-License-Identifier: GPL-3.0-or-later
// The distance from a gyroid at many points, compiled once per instruction set.
#pragma once

namespace vam::solid {

#define VAM_GYROID_KERNELS                                                                                            \
  /* Distances in radians from the surface F = sin x cos y + sin y cos z + sin z cos x = 0 [OST22 Methods]: beyond    \
     `near` a lower bound (|grad F| <= sqrt(3)), nearer the distance to the tangent plane at the foot point, found by \
     Newton steps along the gradient. So a sheet has the same thickness everywhere. */                                \
  void gyroid_distances(const double* x, const double* y, const double* z, int count, double near, double* distances);

namespace baseline {
VAM_GYROID_KERNELS
}
namespace avx2 {
VAM_GYROID_KERNELS
}
namespace avx512 {
VAM_GYROID_KERNELS
}
#undef VAM_GYROID_KERNELS

}  // namespace vam::solid
