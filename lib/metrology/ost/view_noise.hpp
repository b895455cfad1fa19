// SPDX-License-Identifier: GPL-3.0-or-later
// The noise of camera views, measured in the views themselves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "metrology/ost/views.hpp"

namespace vam::metrology {

/// Variance = floor + per_value * value, as cameras have it: read-out and photons [EMVA16]. View units.
struct ViewNoise {
  double floor = 0;
  double per_value = 0;
  [[nodiscard]] double sigma(double value) const;
};

/// From the second differences in both directions, 1 -2 1 by 1 -2 1, which planes and straight upright or level edges
/// leave 0 [IMM96]: their median magnitude among pixels of like brightness. Of at most 24 of the views. Noise that
/// neighbouring pixels share is underestimated.
[[nodiscard]] ViewNoise view_noise(std::span<const CameraView> views);

/// Nothing but noise, drawn anew for each seed: normal, independent from pixel to pixel, as strong as in these views.
[[nodiscard]] std::vector<CameraView> noise_views(std::span<const CameraView> views, const ViewNoise& noise,
                                                  std::uint64_t seed);

}  // namespace vam::metrology
