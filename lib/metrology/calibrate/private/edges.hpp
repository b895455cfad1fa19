// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of the vial at one height of a sweep.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/stats/measured.hpp"
#include "metrology/calibrate/private/sight_lines.hpp"
#include "metrology/calibrate/vial_place.hpp"
#include "model/printer.hpp"

namespace vam::metrology {

inline constexpr double edge_window = 0.25;  // of R_e, to either side of an edge

/// SightLines sees a sheet as a perfect camera would. Effects of lens and position change with the orientation of the
/// sheet, that is with the angle delta of its ray, which near grazing varies with the square root of the depth below
/// the edge, and with its position. Their share is therefore a polynomial in t, the angle from that at the edge plus
/// the depth as a fraction of R_e.
inline constexpr std::size_t edge_powers = 3;
using EdgeTerms = std::array<double, edge_powers>;

/// Visible light of the ray of column q * R_e times 1, t, t^2; 0 beyond the edge. Kept as running integrals over q: a
/// line that has a width is exactly the difference of two integrals, however steep the edge.
class EdgeShape {
 public:
  /// sign: -1 at the low edge.
  EdgeShape(const model::Printer& printer, const SightLines& side, double edge_mm, double sign);
  /// Integrals from 1 - 2 edge_window to q; below that the curves go on level.
  [[nodiscard]] EdgeTerms integral(double q) const;

 private:
  std::vector<EdgeTerms> integral_;
};

struct EdgeShapes {
  EdgeShape low, high;
};

[[nodiscard]] EdgeShapes edge_shapes(const model::Printer& printer);

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
