// SPDX-License-Identifier: GPL-3.0-or-later
// The taps of one output column of resampling.
#pragma once

#include "optics/resample.hpp"

namespace vam::optics {

/// Adds the source of one output column: input position `column`, stretched by `width` >= 1 input columns (a coarser
/// output is an average), at input row `row` for output row 0, all times `weight`. However wide, it costs no more than
/// the input has columns, or some thousand.
void add_source(ResamplePlan& plan, Interpolation interpolation, double column, double width, double row,
                double weight);

}  // namespace vam::optics
