// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/printable.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"

namespace vam::optimize {

void require_printable(const VolumeTask& task, light::Shape shape, const std::string& subject) {
  constexpr float half = 0.5F;
  if (task.demands.grey) return;
  std::vector<float> slice(product(shape.width, shape.height));
  float most = 0;
  for (int k = 0; k < task.source.slices && most < half; ++k) {
    task.source.target(k, 1, slice.data());
    for (int y = 0; y < shape.height; ++y)
      for (int x = 0; x < shape.width; ++x)
        if (task.circle.contains(x, y)) most = std::max(most, slice[flat_index(y, shape.width, x)]);
  }
  if (most <= model::coverage_rounding || most >= half) return;
  throw Error{Fault::data, subject + ": no voxel is at least half covered (maximum " + format_number(most, 2) +
                               "); use smaller voxels or thicken the part"};
}

void require_light(const VolumeOutcome& outcome, const std::string& subject, double band_px) {
  if (outcome.metrics.part == 0) {
    throw Error{Fault::data, subject + ": no part voxel is constrained (" + std::to_string(outcome.dark_part_voxels) +
                                 " are in an insert's shadow); check inserts, weights and tolerances"};
  }
  if (outcome.metrics.max_part > 0) return;
  const std::string why =
      band_px > 0 ? ": hardly any of it is more than " + format_number(band_px, 3) +
                        " voxels from its surface; reduce the margin left unconstrained there"
                  : "; check that the projector's columns and rows cover it and the maximum intensity is above 0";
  throw Error{Fault::data, subject + ": no light reaches the part" + why};
}

}  // namespace vam::optimize
