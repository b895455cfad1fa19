// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/compute/per_slice.hpp"

namespace vam::light {

namespace {

tomo::FilterSpec floored_and_capped(int columns, double angle_step_rad) {
  constexpr double nyquist = 0.5;  // cycles per column; floor and ceiling are fractions of the gain there
  const double over_half_turn = std::numbers::pi / std::abs(angle_step_rad);
  tomo::FilterSpec spec;
  spec.floor = 0.64 / columns / nyquist;
  spec.ceiling = std::clamp(over_half_turn / (std::numbers::pi * columns) / nyquist, spec.floor, 1.0);
  return spec;
}

}  // namespace

Preconditioner::Preconditioner(int columns, double angle_step_rad, double gain, std::vector<float> amplified)
    : gain_(static_cast<float>(gain)),
      amplified_(std::move(amplified)),
      ramp_(columns, {}),
      preconditioner_(columns, floored_and_capped(columns, angle_step_rad)) {}

void Preconditioner::apply(const tomo::Filter& filter, std::span<Slab> sinograms) const {
  if (!amplified_.empty()) scale_columns(sinograms, amplified_);
  for (Slab& slab : sinograms) filter.apply(slab);
  if (!amplified_.empty()) return scale_columns(sinograms, amplified_, gain_);
  for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sinograms[s].values[i] *= gain_;
  });
}

void scale_columns(std::span<Slab> sinograms, std::span<const float> factor, float gain) {
  for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
    float* row = sinograms[s].values.data() + first;
    for (std::size_t i = 0; i < last - first; ++i) row[i] *= factor[i / lanes] * gain;
  });
}

}  // namespace vam::light
