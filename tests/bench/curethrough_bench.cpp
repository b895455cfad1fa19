// SPDX-License-Identifier: GPL-3.0-or-later
// The correction of a part of 1920 x 1080 x 1000 voxels, without reading and writing: the work per slice.
#include <benchmark/benchmark.h>

#include "resin/curethrough/slice_correction.hpp"

namespace {

constexpr int width = 1920;
constexpr int height = 1080;
constexpr int slices = 200;

// Blocks of 40 slices every 60, shifted from column to column so that edges come up in every slice.
const vam::resin::PartColumns& part() {
  static const auto built = [] {
    vam::resin::PartColumns columns(width, height, slices, vam::resin::ExposureMode::continuous);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::size_t column = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
        for (int k = 0; k < slices; ++k) columns.fill(column, k, 1, (k + x / 8 + y / 8) % 60 < 40);
      }
    }
    return columns;
  }();
  return built;
}

void corrected_slice(benchmark::State& state) {
  const vam::resin::CureLimits limits = vam::resin::limits_of({});
  vam::Image slice(width, height);
  for (auto _ : state) {
    state.PauseTiming();
    vam::resin::SliceCorrection correction(part(), limits, {1}, slices + 3);
    state.ResumeTiming();
    for (int k = 0; k < slices; ++k) correction.next(slice);
  }
  state.SetItemsProcessed(state.iterations() * slices * width * height);
}
BENCHMARK(corrected_slice)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
