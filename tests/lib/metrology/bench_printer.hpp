// SPDX-License-Identifier: GPL-3.0-or-later
// The printer of a bench that the oracle renders, and a turn of its views.
#pragma once

#include <utility>
#include <vector>

#include "metrology/ost/views.hpp"
#include "model/printer.hpp"
#include "oracle/bench_views.hpp"

namespace vam {

inline model::Printer printer_of(const oracle::ViewBench& bench) {
  model::Printer printer;
  printer.vial = {.radius_mm = bench.vial_mm, .wall_mm = bench.wall_mm, .index_glass = bench.glass_index};
  printer.bath = {.index = bench.bath_index, .window_mm = bench.window_mm};
  printer.camera.telecentric = bench.lens_mm == 0;
  if (!printer.camera.telecentric) printer.camera.distance_mm = bench.lens_mm;
  printer.camera.absorption_per_mm = bench.absorption_per_mm;
  printer.camera.index_resin = bench.resin_index;
  printer.camera.azimuth_deg = bench.azimuth_deg;
  return printer;
}

inline std::vector<metrology::CameraView> views_of(const oracle::ViewBench& bench,
                                                   const std::vector<std::vector<float>>& pixels) {
  std::vector<metrology::CameraView> views;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Image image(bench.columns, bench.rows);
    image.values = pixels[i];
    views.push_back({std::move(image), 360.0 * static_cast<double>(i) / static_cast<double>(pixels.size())});
  }
  return views;
}

}  // namespace vam
