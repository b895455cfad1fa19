// SPDX-License-Identifier: GPL-3.0-or-later
// The vial's radius from its edges in the projector's field [RAY21 eq 9; physics §10].
#pragma once

#include "model/printer.hpp"

namespace vam::metrology {

/// Outer radius in mm of the vial whose outermost lit column is R_e = edge_px columns from the axis: in air
/// R = R_e / sqrt(1 + (R_e / D_p)^2), which is optics::impact_mm() and has the sign of the square right [physics §12].
/// The vial's radius. If the resin, not the glass, ends the light, the glass is a wall further out.
[[nodiscard]] double vial_radius_mm(const model::Printer& printer, double edge_px);

}  // namespace vam::metrology
