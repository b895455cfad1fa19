// SPDX-License-Identifier: GPL-3.0-or-later
// What a plan says beyond whether the part fits.
#pragma once

#include "model/printer.hpp"
#include "solid/voxel/part.hpp"
#include "vam-plan/plan.hpp"

namespace vam::plan_tool {

/// Walls, gaps and cavities, on the printer's voxels, or on larger ones where these are too many. Warns of what these
/// do not resolve.
void add_walls(Plan& plan, const solid::Part& part);

/// The print of few iterations, on voxels that are larger for large parts, and smaller for those of thin walls or gaps,
/// or that the estimate tears.
void add_preview(Plan& plan, const solid::Part& part, const model::Printer& printer);

}  // namespace vam::plan_tool
