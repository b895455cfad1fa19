// SPDX-License-Identifier: GPL-3.0-or-later
// The grid on which the dose of a stack is computed.
#pragma once

#include <optional>

#include "model/grid.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"

namespace vam::light {

/// The grid of the dose when none is given: cubes as high as a slice, a square around the axis that holds every voxel
/// that can be lit from all sides (projector) or the detector (virtual), or of size_mm; as high as the stack, and as
/// its poses lift the part past the rows. Throws Fault::data when voxels could not be cubes.
[[nodiscard]] model::Grid dose_grid(const model::Printer& printer, const model::StackInfo& info,
                                    std::optional<double> size_mm);

/// The slice of the grid at the first slice of the stack. Throws Fault::data, with both numbers, unless the slices of
/// the stack are slices of the grid.
[[nodiscard]] int first_slice(const model::Grid& grid, const model::StackInfo& info);

}  // namespace vam::light
