// SPDX-License-Identifier: GPL-3.0-or-later
// The sinograms of a volume, a pass at a time.
#pragma once

#include <functional>
#include <vector>

#include "base/compute/slab.hpp"
#include "base/image.hpp"
#include "io/vdb/vdb.hpp"
#include "tomo/filtered_projections.hpp"

namespace vam::sinogram_tool {

/// Calls use(slabs, count) for the sinograms of all slices, a pass of up to 64 at a time, the next slices being read
/// meanwhile.
void for_each_pass(const io::SparseVolume& volume, const tomo::ProjectionSpec& spec,
                   const std::function<void(std::vector<Slab>& sinograms, int count)>& use);

/// The first `count` slices of the slabs.
[[nodiscard]] std::vector<Image> unpacked(const std::vector<Slab>& slabs, int count);

}  // namespace vam::sinogram_tool
