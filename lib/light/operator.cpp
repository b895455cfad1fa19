#include "light/operator.hpp"

#include <algorithm>

#include "base/per_slice.hpp"

namespace vam::light {

namespace {

/// to = from times a factor.
void scaled(const Slab& from, double factor, Slab& to) {
  to = from;
  for (float& v : to.values) v *= static_cast<float>(factor);
}

}  // namespace

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
