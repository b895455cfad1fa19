// Chief-ray dose: voxels x angles x slices per second, N = 512, 360 angles, 64 slices. Need: 2.4 giga-updates/s on two
// cores, for 512 slices in 20 s.
#include <benchmark/benchmark.h>

#include <numbers>

#include "base/parallel.hpp"
#include "light/trace.hpp"
#include "model/printer.hpp"

namespace {

void trace_slices(benchmark::State& state) {
  using namespace vam;
  using namespace vam::optics;
  using namespace vam::light;
  set_threads(static_cast<int>(state.range(0)));
  const int slices = static_cast<int>(state.range(1));
  const model::Printer printer;
  constexpr int n = 512;
  const double voxel_mm = 2 * model::writable_radius_mm(printer) / n;  // the writable circle fills the grid
  TraceSetup setup;
  setup.view = projector_view(printer);
  setup.projector = {1024, 0.065, 511.5};
  setup.turn = {360, 0, 2 * std::numbers::pi / 360};
  setup.grid = model::centred_grid(n, n, slices, voxel_mm);
  const Tracer tracer(setup);
  const std::vector<Image> in(static_cast<std::size_t>(slices), Image(1024, 360, 1.0F));
  std::vector<Image> out(in.size());
  for (auto _ : state) tracer.dose(in, out);
  state.counters["updates"] = benchmark::Counter(1.0 * n * n * 360 * slices * static_cast<double>(state.iterations()),
                                                 benchmark::Counter::kIsRate);
  set_threads(0);
}
BENCHMARK(trace_slices)->ArgsProduct({{1, 2}, {16, 32, 64}})->Unit(benchmark::kMillisecond)->UseRealTime();

void trace_table(benchmark::State& state) {
  using namespace vam;
  using namespace vam::optics;
  using namespace vam::light;
  const model::Printer printer;
  TraceSetup setup;
  setup.view = projector_view(printer);
  setup.projector = {1024, 0.065, 511.5};
  setup.turn = {360, 0, 2 * std::numbers::pi / 360};
  setup.grid = model::centred_grid(512, 512, 1, 2 * model::writable_radius_mm(printer) / 512);
  for (auto _ : state) benchmark::DoNotOptimize(Tracer(setup));
}
BENCHMARK(trace_table)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
