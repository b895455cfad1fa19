// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/filtered_projections.hpp"

#include <algorithm>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "tomo/axis_transmission.hpp"

namespace vam::tomo {

namespace {

FilterSpec matched(FilterSpec filter, const ParallelGeometry& geometry) {
  filter.alpha_per_px = geometry.alpha_per_px;
  return filter;
}

/// Unit of the values, and the light at the wall, e^{alpha sqrt(R^2 - t^2)} times that at the axis [CAL19;
/// physics §5]; columns beyond the wall get the factor of the axis plane, 1.
std::vector<float> column_weights(const ProjectionSpec& spec) {
  const double unit = spec.filter.window == FilterWindow::none ? spec.voxel_mm : 0.5;  // [TM80]: |k| / (4 pi) = |f| / 2
  std::vector<float> weights(spec.geometry.columns, 1.0F);
  if (spec.wall_radius_mm) {
    const double radius_px = *spec.wall_radius_mm / spec.voxel_mm;
    weights = to_the_axis(spec.geometry.columns, spec.geometry.alpha_per_px, radius_px);
  }
  for (float& weight : weights) weight *= static_cast<float>(unit);
  return weights;
}

}  // namespace

FilteredProjections::FilteredProjections(const ProjectionSpec& spec)
    : spec_(spec),
      filter_(spec.geometry.columns, matched(spec.filter, spec.geometry)),
      weights_(column_weights(spec)) {}

void FilteredProjections::apply(std::span<const Slab> images, std::span<Slab> sinograms) const {
  forward(spec_.geometry, images, sinograms);
  for (Slab& sinogram : sinograms) {
    filter_.apply(sinogram);
    parallel_for(sinogram.height, [&](int a) {
      float* value = sinogram.at(0, a);
      for (const float weight : weights_) {
        for (int lane = 0; lane < lanes; ++lane) *value++ *= weight;
      }
    });
  }
}

int slabs_a_pass(const ParallelGeometry& geometry, std::size_t budget_bytes) {
  const std::size_t image = product(geometry.nx, geometry.ny);
  const std::size_t sinogram = product(geometry.columns, geometry.angles);
  const std::size_t slab_bytes =
      (2 * image + 3 * sinogram) * lanes * sizeof(float);  // slabs, slices read, images written
  return static_cast<int>(std::clamp<std::size_t>(budget_bytes / slab_bytes, 1, 4));
}

}  // namespace vam::tomo
