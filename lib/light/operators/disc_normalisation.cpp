// SPDX-License-Identifier: GPL-3.0-or-later
// Absorption corrected by the dose that the projections of a uniform disc give [OST22 Methods; physics §5].
#include <algorithm>
#include <vector>

#include "base/compute/per_slice.hpp"
#include "light/operators/private/attenuated_operator.hpp"
#include "model/circle.hpp"

namespace vam::light {

/// The projections of a uniform disc are made as if nothing were absorbed; what they give with absorption, relative to
/// the disc, is divided out of the objects [OST22 Methods; physics §5].
void AttenuatedOperator::divide_by_disc_dose(std::span<Slab> objects) const {
  std::vector<Slab> disc = slabs(1, dose_.nx, dose_.ny);
  const model::Circle circle{dose_.axis_x, dose_.axis_y, std::min(radius_px_, 0.5 * dose_.columns - 1)};
  for (int y = 0; y < dose_.ny; ++y) {
    for (int x = 0; x < dose_.nx; ++x) std::fill_n(disc[0].at(x, y), lanes, circle.contains(x, y) ? 1.0F : 0.0F);
  }
  std::vector<Slab> light = slabs(1, dose_.columns, dose_.angles);
  tomo::forward(dose_.with_alpha(0), disc, light);
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
