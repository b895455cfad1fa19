// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle's bench of a view.
#pragma once

#include "optics/chief_ray.hpp"
#include "oracle/ray_tracer.hpp"

namespace vam::optics {

inline oracle::Bench bench_of(const View& view) {
  oracle::Bench bench;
  if (view.lens_mm) bench.lens_distance = *view.lens_mm;
  bench.bath = view.bath_index;
  bench.window = view.window_mm;
  for (const Shell& shell : view.shells) bench.cylinders.push_back({shell.radius_mm, shell.index});
  return bench;
}

}  // namespace vam::optics
