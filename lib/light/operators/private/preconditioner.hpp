// SPDX-License-Identifier: GPL-3.0-or-later
// The ramp filter and the preconditioner P: approximate inverses of A A* for parallel or nearly parallel rays.
#pragma once

#include <span>
#include <vector>

#include "base/compute/slab.hpp"
#include "tomo/filter.hpp"

namespace vam::light {

/// With A = W P, P line integrals and W the share of a column's light that reaches the plane of the axis, (A A*)^-1 is
/// about gain W^-1 ramp W^-1; filtered back-projection over a full turn is f = (1/2) integral of ramp P f over theta
/// [KS88 eq 36], so gain = (1/2) angle step where columns are voxels.
class Preconditioner {
 public:
  /// `amplified`: 1 / W of each column, or empty where W = 1.
  Preconditioner(int columns, double angle_step_rad, double gain, std::vector<float> amplified = {});

  /// The ramp, in place.
  void filter(std::span<Slab> sinograms) const { apply(ramp_, sinograms); }
  /// A A* falls off like 1/|k| from the lowest frequency that the circle holds, about 0.64 / columns cycles per column,
  /// up to where neighbouring angles see different things, (angles over half a turn) / (pi columns); beyond, it is
  /// flat. The ramp, floored and capped there, inverts that [physics §6]; it is symmetric and positive definite. In
  /// place.
  void precondition(std::span<Slab> sinograms) const { apply(preconditioner_, sinograms); }

 private:
  void apply(const tomo::Filter& filter, std::span<Slab> sinograms) const;

  float gain_;
  std::vector<float> amplified_;
  tomo::Filter ramp_, preconditioner_;
};

/// Every column's values times its factor and the gain, in place.
void scale_columns(std::span<Slab> sinograms, std::span<const float> factor, float gain = 1);

}  // namespace vam::light
