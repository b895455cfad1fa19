#include "light/operators/private/attenuated_operator.hpp"

#include <algorithm>
#include <cmath>

#include "base/per_slice.hpp"
#include "model/circle.hpp"
#include "tomo/absorption.hpp"

namespace vam::light {

namespace {

tomo::ParallelGeometry with_alpha(tomo::ParallelGeometry geometry, double alpha_per_px) {
  geometry.alpha_per_px = alpha_per_px;
  return geometry;
}

}  // namespace

AttenuatedOperator::AttenuatedOperator(const tomo::ParallelGeometry& turn, double mu_per_px, double resin_radius_px,
                                       Correction correction)
    : dose_(with_alpha(turn, -mu_per_px)),
      radius_px_(resin_radius_px),
      correction_(correction),
      transmitted_(tomo::to_the_axis(turn.columns, -mu_per_px, radius_px_)),
      amplified_(tomo::to_the_axis(turn.columns, mu_per_px, radius_px_)),
      inverse_(turn.columns, turn.angle_step_rad, 0.5 * row_angle_rad(), amplified_),
      clear_(turn.columns, turn.angle_step_rad, 0.5 * row_angle_rad()),
      exact_({.geometry = with_alpha(turn, mu_per_px), .filter = {}, .wall_radius_mm = radius_px_}) {
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
    exact_.work_out(objects, sinograms);
    const auto dose = static_cast<float>(row_angle_rad());
    for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) sinograms[s].values[i] *= dose;
    });
    return;
  }
  std::vector<Slab> corrected(objects.begin(), objects.end());
  divide_by_disc_dose(corrected);
  tomo::forward(with_alpha(dose_, 0), corrected, sinograms);
  clear_.filter(sinograms);
}

/// The projections of a uniform disc are made as if nothing were absorbed; what they give with absorption, relative to
/// the disc, is divided out of the objects [OST22 Methods; physics §5].
void AttenuatedOperator::divide_by_disc_dose(std::span<Slab> objects) const {
  std::vector<Slab> disc = slabs(1, dose_.nx, dose_.ny);
  const model::Circle circle{dose_.axis_x, dose_.axis_y, std::min(radius_px_, 0.5 * dose_.columns - 1)};
  for (int y = 0; y < dose_.ny; ++y) {
    for (int x = 0; x < dose_.nx; ++x) std::fill_n(disc[0].at(x, y), lanes, circle.contains(x, y) ? 1.0F : 0.0F);
  }
  std::vector<Slab> light = slabs(1, dose_.columns, dose_.angles);
  tomo::forward(with_alpha(dose_, 0), disc, light);
  clear_.filter(light);
  clip_below(light, 0.0F);
  std::vector<Slab> dose = slabs(1, dose_.nx, dose_.ny);
  adjoint(light, dose);
  float largest = 0;
  for (const float d : dose[0].values) largest = std::max(largest, d);
  constexpr float least = 0.01F;  // of the largest dose: outside the disc there is none to divide by
  for_values(objects, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      objects[s].values[i] /= std::max(dose[0].values[i] / largest, least);
    }
  });
}

}  // namespace vam::light
