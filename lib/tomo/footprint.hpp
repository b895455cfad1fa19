// SPDX-License-Identifier: GPL-3.0-or-later
// The shadow of a square voxel under parallel rays: a trapezoid, box(wide) * box(narrow) [LF10].
// For kernels, too: no call, no branch, nothing that another instruction set could share.
#pragma once

namespace vam::tomo {

/// Area between the shadow's centre and x, negative for x before it:
///   sign(x) (slope y - curve z^2),  y = min(|x|, half),  z = y - min(y, flat).
struct Trapezoid {
  float half;   // half the base
  float flat;   // half the top; less than half
  float slope;  // the trapezoid's height
  float curve;  // slope / (2 (half - flat))

  /// The footprint of `total` area whose sides are `wide` >= `narrow` >= 0, in any unit of which a voxel has about one.
  [[gnu::always_inline]] static Trapezoid of(float wide, float narrow, float total) {
    const float flank =
        narrow > 1e-6F ? narrow : 1e-6F;  // narrower it is a box to float precision; 1 / flank stays finite
    const float curve = total / (2.0F * flank * wide);
    return {0.5F * (wide + flank), 0.5F * (wide - flank), 2.0F * flank * curve, curve};
  }

  [[gnu::always_inline]] [[nodiscard]] float area_up_to(float x) const {
    const float size = __builtin_fabsf(x);
    const float y = size < half ? size : half;
    const float z = y - (y < flat ? y : flat);
    return __builtin_copysignf(slope * y - curve * (z * z), x);
  }
};

}  // namespace vam::tomo
