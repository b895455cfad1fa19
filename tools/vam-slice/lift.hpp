// SPDX-License-Identifier: GPL-3.0-or-later
// --place: the height of the part in the image.
#pragma once

#include "base/text/json_fwd.hpp"
#include "model/printer.hpp"
#include "solid/voxel/part.hpp"
#include "vam-slice/options.hpp"

namespace vam::slice_tool {

/// The lift of the part along z, in whole voxels of the stretched target: to the requested height; to that of least
/// smear by climbing rays; or, unless it keeps its origin, as little as brings it into the image. Throws Fault::usage
/// for an invalid height.
[[nodiscard]] double lift_mm(const Options& options, const model::Printer& printer, const solid::Part& part,
                             const solid::Writable& room);

/// For --report: the lift in the resin.
[[nodiscard]] Json lift_figures(const Options& options, double lift_mm);

}  // namespace vam::slice_tool
