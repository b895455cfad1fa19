// The one-sided loss: void should stay below d_l, part should reach d_h, and nothing else is asked [physics section 6].
#pragma once

#include "optimize/pass.hpp"

namespace vam::optimize {

/// Slope of (1/2) max(0, D - d_l)^2 in the void and (1/2) max(0, d_h - D)^2 in the part.
inline float slope(float dose, Label label, const Window& window) {
  const auto low = static_cast<float>(window.low);
  const auto high = static_cast<float>(window.high);
  if (label == Label::void_) return dose > low ? dose - low : 0.0F;
  if (label == Label::part) return dose < high ? dose - high : 0.0F;
  return 0.0F;
}

/// The loss of each slice: the sum over its voxels.
[[nodiscard]] PerSlice loss(std::span<const Slab> dose, const Problem& problem);

}  // namespace vam::optimize
