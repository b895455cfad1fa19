// SPDX-License-Identifier: GPL-3.0-or-later
// Writable radius R_w: how far from the rotation axis a printer can write [physics §2].
#pragma once

#include "model/printer.hpp"
#include "optics/chief_ray.hpp"

namespace vam::optics {

/// Largest |b| n_0 of a ray that passes every shell: n b is conserved, and sin = n b / (n_k R_k) <= 1 on both sides of
/// each shell.
[[nodiscard]] double largest_invariant(const View& view);

/// The largest distance of a ray that meets the resin.
[[nodiscard]] double grazing_impact_mm(const View& view);

/// Largest |x_v| of any ray in the resin; inside this radius every point is lit from all sides.
[[nodiscard]] double reach_mm(const View& view);

/// Largest radius in mm that light reaches from all sides: every chief ray's (reach_mm) and, on the narrower side, that
/// of the projector's outermost column, for rays that stay level [RAY21 section 2; physics §2]. Every tool judges by
/// this radius. Throws Fault::data as projector_view does, and when the projector's columns do not straddle the axis.
[[nodiscard]] double writable_radius_mm(const model::Printer& printer);

/// The radius in mm up to which resin is constrained and judged: the writable radius, and all of the resin for a part
/// whose farthest voxel lies beyond, where light reaches it from some angles only.
[[nodiscard]] double judged_radius_mm(const model::Printer& printer, double farthest_mm);

}  // namespace vam::optics
