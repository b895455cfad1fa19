// SPDX-License-Identifier: GPL-3.0-or-later
// The trace of an optimisation, or another table, as curves.
#pragma once

#include "plot/plot.hpp"
#include "vam-view/options.hpp"

namespace vam::view_tool {

/// Of the input, and of a trace also that of --compare.
[[nodiscard]] plot::Plot trace_plot(const Options& options);

}  // namespace vam::view_tool
