// SPDX-License-Identifier: GPL-3.0-or-later
// The rays of one projector row, column by column, as CSV.
#pragma once

#include <iosfwd>

#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optics/resample.hpp"

namespace vam::optics {

/// The exact rays of one row as CSV: column,row,x_p_mm,z_p_mm,x_v_mm,z_mm,climb,delta_deg,T, one line a column; the
/// last five are empty where a ray misses the resin. z_mm is the height in the resin at the point nearest to the axis,
/// climb the height gained per length seen from above, as optics::SkewRay has them.
void write_rays(std::ostream& out, const model::Printer& printer, const Detector& detector, int row);

/// By how many slices the light of the outermost row that a sinogram uses departs from its own slice within the reach
/// of its rays: max |z(u) - M_vp z_p| / (M_vp pitch) over |u| <= reach_mm, for the ray through the axis [physics §11].
/// Rows beyond the projector's are not used. 0 where rays stay level. Throws Fault::data as projector_view does.
[[nodiscard]] double crossed_slices(const model::Printer& printer, const model::StackInfo& info);

}  // namespace vam::optics
