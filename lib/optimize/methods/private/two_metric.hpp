// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds and a preconditioner together: two-metric projection [BER82; physics §6].
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/compute/per_slice.hpp"

namespace vam::optimize {

/// A step g <- clamp(g - s P d, 0, peak) along a preconditioned gradient P d need not go downhill where it is clipped.
/// So values at a bound that the plain gradient d would push beyond it are held there, and only the others take part.
class TwoMetric {
 public:
  /// Notes which values of g are held, and takes them out of d, which is then ready for the preconditioner. at(s, i):
  /// g.
  template <class At>
  void fix_active_bounds(std::vector<Slab>& d, float peak, const At& at) {
    held_.resize(d.size(), std::vector<std::uint16_t>(d[0].values.size() / lanes));
    for_values(d, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; i += lanes) {
        unsigned bits = 0;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const float g = at(s, i + lane);
          float& slope = d[s].values[i + lane];
          const bool held = (g <= 0 && slope > 0) || (g >= peak && slope < 0);
          bits |= held ? 1U << lane : 0U;
          slope = held ? 0.0F : slope;
        }
        held_[s][i / lanes] = static_cast<std::uint16_t>(bits);
      }
    });
  }

  /// g after a step down along Pd.
  [[nodiscard]] float step(std::size_t s, std::size_t i, float g, float down, float peak) const {
    const bool held = ((held_[s][i / lanes] >> (i % lanes)) & 1U) != 0;
    return std::clamp(held ? g : g - down, 0.0F, peak);
  }

 private:
  std::vector<std::vector<std::uint16_t>> held_;  // a bit for each slice
};

}  // namespace vam::optimize
