// SPDX-License-Identifier: GPL-3.0-or-later
// How many slices the light of one projector row crosses where chief rays climb.
#pragma once

#include "model/printer.hpp"
#include "model/stack.hpp"

namespace vam::optics {

/// By how many slices the light of the outermost row that a sinogram uses departs from its own slice within the reach
/// of its rays: max |z(u) - M_vp z_p| / (M_vp pitch) over |u| <= reach_mm, for the ray through the axis [physics §11].
/// Rows beyond the projector's are not used. 0 where rays stay level. Throws Fault::data as projector_view does.
[[nodiscard]] double crossed_slices(const model::Printer& printer, const model::StackInfo& info);

}  // namespace vam::optics
