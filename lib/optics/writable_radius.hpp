// Writable radius R_w: how far from the rotation axis a printer can write [physics §2].
#pragma once

#include "model/printer.hpp"

namespace vam::optics {

/// Largest radius in mm that light reaches from all sides: every chief ray's (reach_mm) and, on the narrower side, that
/// of the projector's outermost column, for rays that stay level [RAY21 section 2; physics §2]. Every tool judges by
/// this radius. Throws Fault::data as projector_view does, and when the projector's columns do not straddle the axis.
[[nodiscard]] double writable_radius_mm(const model::Printer& printer);

/// The radius in mm up to which resin is constrained and judged: the writable radius, and all of the resin for a part
/// whose farthest voxel lies beyond, where light reaches it from some angles only.
[[nodiscard]] double judged_radius_mm(const model::Printer& printer, double farthest_mm);

}  // namespace vam::optics
