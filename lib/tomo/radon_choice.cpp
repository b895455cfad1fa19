// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/radon_choice.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "tomo/private/gridding.hpp"
#include "tomo/private/radon_plan.hpp"

namespace vam::tomo {

namespace {

// Medians of tests/bench/radon_bench.cpp over sides 128 to 1024 (EPYC of 2.6 GHz, AVX-512), A and A*.
constexpr double footprint_ns = 6;         // a pixel and angle of a slab alone: weights, and 16 multiplications
constexpr double shared_footprint_ns = 4;  // of four slabs that share the weights

struct FourierTimes {
  double grid_ns;   // a grid point of a row or column that is transformed
  double point_ns;  // a point on a line
  double bin_ns;    // a bin of an angle
};
constexpr FourierTimes slab_times{50, 95, 100};
constexpr FourierTimes slice_times{7, 38, 24};

}  // namespace

RadonCost radon_cost(const ParallelGeometry& geometry, std::size_t slabs, FourierRadon::Slices slices) {
  const bool one = slices == FourierRadon::Slices::one;
  const double rays = count_of(make_plan(geometry, {}, {}).rays);
  const double pixels = static_cast<double>(geometry.nx) * geometry.ny;
  const double bins = std::max(static_cast<double>(geometry.columns), std::hypot(geometry.nx, geometry.ny));
  const double grid = static_cast<double>(grid_points(geometry.nx)) * (geometry.ny + grid_points(geometry.ny));
  const FourierTimes& times = one ? slice_times : slab_times;
  const double slab_count = static_cast<double>(slabs);
  const double footprint = slabs < group_slabs ? footprint_ns : shared_footprint_ns;
  return {slab_count * pixels * rays * footprint,
          slab_count * (grid * times.grid_ns + rays * bins * ((one ? 1 : 2) * times.point_ns + times.bin_ns))};
}

}  // namespace vam::tomo
