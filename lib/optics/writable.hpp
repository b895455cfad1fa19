// How far from the rotation axis a printer can write.
#pragma once

#include "model/printer.hpp"

namespace vam::optics {

/// Largest radius in mm that light reaches from all sides: every chief ray's (reach_mm) and, on the narrower side, that
/// of the projector's outermost column, for rays that stay level [RAY21 section 2; physics §2]. Every tool judges by
/// this radius. Throws Fault::data as projector_view does, and when the projector's columns do not straddle the axis.
[[nodiscard]] double writable_radius_mm(const model::Printer& printer);

}  // namespace vam::optics
