#include "light/operator.hpp"

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

}  // namespace vam::light
