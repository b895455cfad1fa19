// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/attenuated_operator.hpp"

#include "base/compute/per_slice.hpp"
#include "tomo/axis_transmission.hpp"

namespace vam::light {

AttenuatedOperator::AttenuatedOperator(const tomo::ParallelGeometry& turn, double mu_per_px, double resin_radius_px,
                                       Correction correction)
    : dose_(turn.with_alpha(-mu_per_px)),
      radius_px_(resin_radius_px),
      correction_(correction),
      transmitted_(tomo::to_the_axis(turn.columns, -mu_per_px, radius_px_)),
      amplified_(tomo::to_the_axis(turn.columns, mu_per_px, radius_px_)),
      inverse_(turn.columns, turn.angle_step_rad, 0.5 * row_angle_rad(), amplified_),
      clear_(turn.columns, turn.angle_step_rad, 0.5 * row_angle_rad()),
      exact_({.geometry = turn.with_alpha(mu_per_px), .filter = {}, .wall_radius_mm = radius_px_}) {
  tomo::require_translucent(mu_per_px, resin_radius_px);
}

void AttenuatedOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  tomo::forward(dose_, objects, sinograms);
  scale_columns(sinograms, transmitted_);
}

void AttenuatedOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  std::vector<Slab> dimmed(sinograms.begin(), sinograms.end());
  scale_columns(dimmed, transmitted_);
  tomo::adjoint(dose_, dimmed, objects);
}

/// g = e^{mu sqrt(R^2 - t^2)} * (ramp on |k| >= mu) * T_mu f [TM80, CAL19 eq 2; physics §5]: weight e^{+mu u} on the
/// way in.
void AttenuatedOperator::invert(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  if (correction_ == Correction::exact) {
    exact_.apply(objects, sinograms);
    const auto dose = static_cast<float>(row_angle_rad());
    for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) sinograms[s].values[i] *= dose;
    });
    return;
  }
  std::vector<Slab> corrected(objects.begin(), objects.end());
  divide_by_disc_dose(corrected);
  tomo::forward(dose_.with_alpha(0), corrected, sinograms);
  clear_.filter(sinograms);
}

}  // namespace vam::light
