// SPDX-License-Identifier: GPL-3.0-or-later
// From sinogram values to projected intensity: clipping, full scale and lower bound.
#pragma once

#include <optional>
#include <span>

#include "base/image.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::light {

/// What a projector makes of sinogram values.
struct DisplayRange {
  bool clip = true;                  // no negative light
  std::optional<double> full_scale;  // the value shown at full intensity: light is value / this, at most 1
  double dark = 0;                   // least light, of full; only with full_scale
};

/// Statistics of sinogram values, summed up over all calls; in the unit of the values (1/rad).
struct LightSeen {
  double peak = 0;                    // largest value
  model::LightEfficiency efficiency;  // of the intensities that result
  double least = 0;                   // smallest value; negative where some are
  double values = 0;                  // number of values
  double negative = 0;                // how many of them are below 0
};

/// Turns values into intensities, in place: fractions of full scale 0 ... 1, or the values, clipped, without one.
void shine(const DisplayRange& light, std::span<Image> sinograms, LightSeen& seen);

}  // namespace vam::light
