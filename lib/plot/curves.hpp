// SPDX-License-Identifier: GPL-3.0-or-later
// Figures with curves that several tools draw: an optimisation over its iterations, a print's deviation.
#pragma once

#include <string>
#include <vector>

#include "plot/plot.hpp"

namespace vam::plot {

struct Trace {
  std::string name;  // before the names of the curves; none when empty
  std::vector<double> iteration;
  std::vector<double> ver;
  std::vector<double> window;  // relative to the largest dose
};

/// VER and process window of one run, or of two in colours of their own.
[[nodiscard]] Plot convergence(const std::vector<Trace>& traces);

/// The distances of a print from its design, by area: bins of equal width about 0 in mm; the outermost two hold all
/// that is beyond, and the legend says how much.
[[nodiscard]] Plot deviation_histogram(const Histogram& histogram, double rms_mm);

}  // namespace vam::plot
