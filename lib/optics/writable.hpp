// How far from the rotation axis a printer can write.
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

/// The fraction of stage angles [0, 1] from which a ray of the projector's columns lights the resin at that distance
/// from the axis, for rays that stay level: 1 up to the writable radius.
[[nodiscard]] double lit_fraction(const model::Printer& printer, double radius_mm);

}  // namespace vam::optics
