// SPDX-License-Identifier: GPL-3.0-or-later
// From a frame's vertical blank to its light: a blinking screen, seen by a camera whose frames have times.
#pragma once

#include <utility>
#include <vector>

#include "base/stats/measured.hpp"

namespace vam::metrology {

struct BlinkScan {
  std::vector<std::pair<double, double>> lit_s;  // from the flip to light until the flip to black, one after the other
  double exposure_s = 0;                         // of the camera, above 0
  std::vector<double> begin_s;                   // of each frame's exposure, the same clock, rising
  std::vector<double> light;                     // mean of each frame
};

struct Latency {
  stats::Measured ms;   // the light comes so much after its flip; the camera's own time stamps count as true
  double contrast = 0;  // light over scatter
};

/// Fits ground + light * (part of the exposure that the delayed light was on) [physics §10], between -20 and 300 ms:
/// every valley of the misfit, of which the deepest must be clearly so [VUO89], within exposures that miss no stretch
/// of latencies. Blinks that follow no pattern have one valley. Throws Fault::data: fewer than 8 frames, no contrast,
/// two valleys that fit alike, and exposures that keep step with the flips and leave the latency open between them.
[[nodiscard]] Latency measure_latency(const BlinkScan& scan);

}  // namespace vam::metrology
