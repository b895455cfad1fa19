// SPDX-License-Identifier: GPL-3.0-or-later
// Colours for values: even to the eye, so that equal steps of the value look equal.
#pragma once

#include "base/pixels.hpp"

namespace vam::plot {

enum class ColourMap {
  grey,       // black to white: coverage, light
  viridis,    // dark blue to yellow: dose and other amounts
  diverging,  // blue, white, red: signed values, white at the middle
};

/// The colour at a place in [0, 1]; places outside take the end's colour.
[[nodiscard]] Rgb colour(ColourMap map, double place);

}  // namespace vam::plot
