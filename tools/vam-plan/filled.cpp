// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-plan/filled.hpp"

#include <algorithm>

#include "base/compute/memory.hpp"
#include "model/grid_size.hpp"

namespace vam::plan_tool {

Filled filled(const solid::Part& part, double voxel_mm) {
  Filled made{{solid::grid_around(part.extent, voxel_mm, 0, part.lattice, part.subject), {}}, {}};
  model::Volume& volume = made.volume;
  require_memory(sizeof(float) * static_cast<double>(volume.grid.size()),
                 part.subject + ": " + model::size_text(volume.grid), "plan a smaller part");
  volume.values.resize(volume.grid.size());
  made.content = solid::fill(part, volume.grid, [&](int k0, int count, const float* slices) {
    std::copy_n(slices, static_cast<std::size_t>(count) * volume.grid.slice_size(), volume.slice(k0));
  });
  return made;
}

}  // namespace vam::plan_tool
