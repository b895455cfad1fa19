// SPDX-License-Identifier: GPL-3.0-or-later
// One volume from 180 views of 480 x 300 pixels: the limit is 1.0 s on two cores, and 30 frames a second live.
#include <benchmark/benchmark.h>

#include <cmath>

#include "metrology/ost/ost.hpp"

namespace {

std::vector<vam::metrology::CameraView> views(int count) {
  std::vector<vam::metrology::CameraView> all;
  for (int a = 0; a < count; ++a) {
    vam::Image image(480, 300);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const float across = static_cast<float>(x) - 239.5F - 40 * std::cos(0.035F * static_cast<float>(a));
        image(x, y) = std::exp(-across * across / 2000);
      }
    }
    all.push_back({std::move(image), 360.0 * a / count});
  }
  return all;
}

void reconstruct(benchmark::State& state) {
  const auto turn = views(180);
  const vam::model::Printer printer;
  const vam::metrology::AxisPose axis{239.5, state.range(0) != 0 ? 0.005 : 0.0};
  const vam::metrology::OstReconstructor reconstructor(printer, 0.05, 480, 300, axis, {});
  for (auto _ : state) benchmark::DoNotOptimize(reconstructor.reconstruct(turn).values.data());
  const auto& grid = reconstructor.grid();
  state.counters["voxels"] = static_cast<double>(grid.size());
  state.counters["views/s"] = benchmark::Counter(180, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(reconstruct)->ArgName("tilted")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
