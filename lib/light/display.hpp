// From sinogram values to the light that a projector shows.
#pragma once

#include <optional>
#include <span>

#include "base/image.hpp"
#include "model/dose_metrics.hpp"

namespace vam::light {

/// What a projector makes of sinogram values.
struct DisplayRange {
  bool clip = true;                  // no negative light
  std::optional<double> full_scale;  // the value shown at full intensity: light is value / this, at most 1
  double dark = 0;                   // least light, of full; only with full_scale
};

/// What there was to see in the values.
struct LightSeen {
  double peak = 0;
  model::LightEfficiency efficiency;  // of the light that was left
  double least = 0;
  double values = 0;
  double negative = 0;
};

/// Turns values into light, in place.
void shine(const DisplayRange& light, std::span<Image> sinograms, LightSeen& seen);

}  // namespace vam::light
