// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/operator.hpp"

#include <algorithm>

#include "base/compute/per_slice.hpp"

namespace vam::light {

namespace {

/// to = from times a factor.
void scaled(const Slab& from, double factor, Slab& to) {
  to = from;
  for (float& v : to.values) v *= static_cast<float>(factor);
}

/// A map of whole passes, for a part of one: what is beyond is dark.
template <class Map>
void within(const Window<const Slab>& from, const Window<Slab>& to, const Map& map) {
  const std::size_t count = std::max(from.end(), to.end());
  std::vector<Slab> given = slabs(count, from.slabs[0].width, from.slabs[0].height);
  std::vector<Slab> made = slabs(count, to.slabs[0].width, to.slabs[0].height);
  for (std::size_t s = from.first; s < from.end(); ++s) given[s].values = from[s].values;
  map(given, made);
  for (std::size_t s = to.first; s < to.end(); ++s) to[s].values = made[s].values;
}

}  // namespace

void Operator::adjoint_within(const Window<const Slab>& sinograms, const Window<Slab>& objects) const {
  within(sinograms, objects, [this](const auto& from, auto& to) { adjoint(from, to); });
}

void Operator::forward_within(const Window<const Slab>& objects, const Window<Slab>& sinograms) const {
  within(objects, sinograms, [this](const auto& from, auto& to) { forward(from, to); });
}

void Operator::invert(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  forward(objects, sinograms);
  filter(sinograms);
}

void Operator::expand(const Slab& sinogram, Slab& image) const { scaled(sinogram, 1 / row_angle_rad(), image); }

void Operator::collapse(const Slab& image, Slab& sinogram) const { scaled(image, row_angle_rad(), sinogram); }

std::vector<Slab> dose_of_even_light(const Operator& light, std::size_t count) {
  Slab even(light.image().width, light.image().height);
  std::fill(even.values.begin(), even.values.end(), 1.0F);
  std::vector<Slab> sinograms = slabs(count, light.sinogram().width, light.sinogram().height);
  for (Slab& slab : sinograms) light.collapse(even, slab);
  std::vector<Slab> dose = slabs(count, light.object().width, light.object().height);
  light.adjoint(sinograms, dose);
  return dose;
}

}  // namespace vam::light
