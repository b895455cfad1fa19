// SPDX-License-Identifier: GPL-3.0-or-later
// Share of the stage angles from which a point is lit, beyond the writable radius [physics §4].
#pragma once

#include <vector>

#include "model/printer.hpp"

namespace vam::optics {

/// The fraction of stage angles [0, 1] from which a ray of the projector's columns lights the resin at that distance
/// from the axis, for rays that stay level: 1 up to the writable radius.
[[nodiscard]] double lit_fraction(const model::Printer& printer, double radius_mm);
/// The same at many distances, in parallel.
[[nodiscard]] std::vector<double> lit_fractions(const model::Printer& printer, const std::vector<double>& radii_mm);

}  // namespace vam::optics
