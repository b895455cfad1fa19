// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of the vial at one height of a sweep.
#pragma once

#include <vector>

#include "base/stats/measured.hpp"
#include "metrology/calibrate/private/edge_shape.hpp"
#include "metrology/calibrate/vial_place.hpp"

namespace vam::metrology {

/// Columns of the two steepest changes, smoothed over three frames; clear when they stand out of the noise, with a dark
/// side before and after.
struct SteepestEdges {
  double rise = 0, fall = 0;
  bool clear = false;
};
[[nodiscard]] SteepestEdges steepest(const std::vector<double>& column, const std::vector<double>& signal);

/// Readings that a fit needs at least.
inline constexpr std::size_t least_readings = 20;

/// In columns.
struct BandEdges {
  stats::Measured centre, edge, blur;
};

/// Begins where the signal changes most. Throws Fault::data when the fit does not settle.
[[nodiscard]] BandEdges fit_band(const SweepScan& scan, const std::vector<double>& signal, const EdgeShapes& shapes,
                                 const SteepestEdges& first);

}  // namespace vam::metrology
