// SPDX-License-Identifier: GPL-3.0-or-later
// A part on voxels of some size.
#pragma once

#include "model/grid.hpp"
#include "solid/voxel/part.hpp"

namespace vam::plan_tool {

struct Filled {
  model::Volume volume;
  solid::FillSummary content;
};

/// Throws Error: no_memory.
[[nodiscard]] Filled filled(const solid::Part& part, double voxel_mm);

[[nodiscard]] inline solid::Part without_surface(solid::Part part) {
  part.surface = {};
  return part;
}

}  // namespace vam::plan_tool
