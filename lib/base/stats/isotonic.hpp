// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest curve that never falls.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vam::stats {

/// Consecutive values that became their mean.
struct Pool {
  double sum = 0;  // weighted
  double weight = 0;
  std::size_t size = 0;
  [[nodiscard]] double mean() const { return sum / weight; }
};

/// The values that never fall and have the least weighted squared distance from `values`, by pooling neighbours that
/// fall [AYER55; physics §14.3]: runs of equal values, in order. Weights > 0, one a value.
[[nodiscard]] inline std::vector<Pool> isotonic(std::span<const double> values, std::span<const double> weights) {
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i] * weights[i], weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back() = {pools.back().sum + last.sum, pools.back().weight + last.weight, pools.back().size + last.size};
    }
  }
  return pools;
}

}  // namespace vam::stats
