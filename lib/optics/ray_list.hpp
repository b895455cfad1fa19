// SPDX-License-Identifier: GPL-3.0-or-later
// The rays of one projector row, column by column, as CSV.
#pragma once

#include <iosfwd>

#include "model/printer.hpp"
#include "optics/resample.hpp"

namespace vam::optics {

/// The exact rays of one row as CSV: column,row,x_p_mm,z_p_mm,x_v_mm,z_mm,climb,delta_deg,T, one line a column; the
/// last five are empty where a ray misses the resin. z_mm is the height in the resin at the point nearest to the axis,
/// climb the height gained per length seen from above, as optics::SkewRay has them.
void write_rays(std::ostream& out, const model::Printer& printer, const Detector& detector, int row);

}  // namespace vam::optics
