// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/unresolved.hpp"

#include <algorithm>
#include <vector>

#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::optimize {

namespace {

constexpr float empty = model::coverage_rounding;
constexpr float full = 1 - model::coverage_rounding;

struct Neighbours {
  bool any_full = false, any_empty = false;
};

Neighbours neighbours(const model::Volume& target, int i, int j, int k) {
  const model::Grid& grid = target.grid;
  Neighbours found;
  found.any_empty = i == 0 || j == 0 || k == 0 || i == grid.nx - 1 || j == grid.ny - 1 || k == grid.nz - 1;
  for (int w = std::max(k - 1, 0); w <= std::min(k + 1, grid.nz - 1); ++w) {
    for (int v = std::max(j - 1, 0); v <= std::min(j + 1, grid.ny - 1); ++v) {
      const float* row = target.slice(w) + static_cast<std::ptrdiff_t>(v) * grid.nx;
      for (int u = std::max(i - 1, 0); u <= std::min(i + 1, grid.nx - 1); ++u) {
        found.any_full = found.any_full || row[u] >= full;
        found.any_empty = found.any_empty || row[u] <= empty;
      }
    }
  }
  return found;
}

Unresolved of_slice(const model::Volume& target, int k) {
  const model::Grid& grid = target.grid;
  Unresolved sums;
  const float* value = target.slice(k);
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i, ++value) {
      const auto coverage = static_cast<double>(*value);
      sums.whole += coverage;
      if (*value <= empty || *value >= full) continue;
      const Neighbours near = neighbours(target, i, j, k);
      if (!near.any_full) sums.part += coverage;
      if (!near.any_empty) sums.gaps += 1 - coverage;
    }
  }
  return sums;
}

}  // namespace

Unresolved unresolved(const model::Volume& target) {
  std::vector<Unresolved> slices(target.grid.nz);
  parallel_for(target.grid.nz, [&](int k) { slices[k] = of_slice(target, k); });
  constexpr double much = 0.1;
  Unresolved all;
  double most = 0;
  for (int k = 0; k < target.grid.nz; ++k) {
    const Unresolved& one = slices[k];
    all.part += one.part;
    all.gaps += one.gaps;
    all.whole += one.whole;
    if (one.part + one.gaps <= most) continue;
    most = one.part + one.gaps;
    all.slice = k;
  }
  for (int k = 0; k < target.grid.nz && most > 0; ++k) {
    if (slices[k].part + slices[k].gaps < much * most) continue;
    if (all.end == 0) all.first = k;
    all.end = k + 1;
  }
  return all;
}

}  // namespace vam::optimize
