// SPDX-License-Identifier: GPL-3.0-or-later
// Resampling: time for 64 slices of 1024 x 360. Budget: 3 ms a slice and core.
#include <benchmark/benchmark.h>

#include <numbers>

#include "base/compute/parallel.hpp"
#include "model/printer.hpp"
#include "optics/resample.hpp"

namespace {

void resample_slices(benchmark::State& state) {
  using namespace vam;
  using namespace vam::optics;
  set_threads(static_cast<int>(state.range(0)));
  const model::Printer printer;
  const Detector virtual_ = centred_detector(512, 0.065);
  const Detector projector{1024, 0.065, 511.5};
  const Turn turn{360, 0, 2 * std::numbers::pi / 360};
  const ResamplePlan plan = plan_to_projector(projector_view(printer), virtual_, projector, turn, {});
  const std::vector<Image> in(64, Image(512, 360, 1.0F));
  std::vector<Image> out(64);
  for (auto _ : state) resample(plan, in, out);
  state.counters["ms_per_slice_core"] =
      benchmark::Counter(64e-3 * static_cast<double>(state.iterations()) / static_cast<double>(state.range(0)),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  set_threads(0);
}
BENCHMARK(resample_slices)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
