// SPDX-License-Identifier: GPL-3.0-or-later
// The distances of a print from its design, by area.
#pragma once

#include "plot/plot.hpp"

namespace vam::plot {

/// Bins of equal width about 0 in mm; the outermost two hold all that is beyond, and the legend says how much.
[[nodiscard]] Plot deviation_histogram(const Histogram& histogram, double rms_mm);

}  // namespace vam::plot
