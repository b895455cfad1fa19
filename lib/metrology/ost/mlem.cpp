// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/mlem.hpp"

#include <algorithm>
#include <vector>

namespace vam::metrology {

namespace {

/// MLEM never leaves 0: the start is a little above.
float lift(std::span<Slab> images) {
  float brightest = 0;
  for (const Slab& image : images) {
    brightest = std::max(brightest, *std::max_element(image.values.begin(), image.values.end()));
  }
  const float floor = 1e-3F * brightest;
  for (Slab& image : images) {
    for (float& x : image.values) x = std::max(x, floor);
  }
  return floor;
}

/// g / A x, in place of A x.
void divide(const Slab& measured, float floor, Slab& projected) {
  for (std::size_t i = 0; i < projected.values.size(); ++i) {
    float& p = projected.values[i];
    p = p > floor ? std::max(0.0F, measured.values[i]) / p : 0.0F;
  }
}

void multiply(const Slab& back, const Slab& norm, Slab& image) {
  for (std::size_t i = 0; i < back.values.size(); ++i) {
    const float n = norm.values[i];
    image.values[i] *= n > 0 ? back.values[i] / n : 0.0F;
  }
}

}  // namespace

void maximise_likelihood(const tomo::ParallelGeometry& geometry, std::span<const Slab> sinograms, int iterations,
                         std::span<Slab> images) {
  std::vector<Slab> ones(1, Slab(geometry.columns, geometry.angles));
  std::fill(ones[0].values.begin(), ones[0].values.end(), 1.0F);
  std::vector<Slab> norm(1, Slab(geometry.nx, geometry.ny));
  tomo::adjoint(geometry, ones, norm);
  std::vector<Slab> ratio(images.size(), Slab(geometry.columns, geometry.angles));
  std::vector<Slab> back(images.size(), Slab(geometry.nx, geometry.ny));
  const float floor = lift(images);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    tomo::forward(geometry, images, ratio);
    for (std::size_t s = 0; s < images.size(); ++s) divide(sinograms[s], floor, ratio[s]);
    tomo::adjoint(geometry, ratio, back);
    for (std::size_t s = 0; s < images.size(); ++s) multiply(back[s], norm[0], images[s]);
  }
}

}  // namespace vam::metrology
