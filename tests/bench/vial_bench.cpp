// SPDX-License-Identifier: GPL-3.0-or-later
// The vial's pair: voxels x angles x slices per second, N = 256, 360 angles, rays that stay level and rays that climb,
// of chief rays and of light that has width.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/compute/per_slice.hpp"
#include "light/operators/private/vial_operator.hpp"
#include "optics/writable_radius.hpp"

namespace {

using namespace vam;

light::VialSetup setup_of(bool climbs, int slices, bool wide = false) {
  model::Printer printer;
  if (wide) printer.projector.half_angle_deg = 0.64;
  if (!wide) printer.stage.motion = "stepped";
  const double voxel_mm = 0.065;
  light::VialSetup setup =
      light::vial_setup(printer, model::centred_grid(256, 256, slices, voxel_mm, -0.5 * slices * voxel_mm), 360,
                        optics::writable_radius_mm(printer));
  if (!climbs) {
    setup.view.rows_lens_mm.reset();
    setup.rows_half_angle_rad = 0;
  }
  return setup;
}

template <class Apply>
void measure(benchmark::State& state, Apply apply) {
  const int slices = static_cast<int>(state.range(1));
  const light::VialOperator light(setup_of(state.range(0) != 0, slices, state.range(2) != 0));
  const auto slabs_used = static_cast<std::size_t>(slices / lanes);
  std::vector<Slab> rows = slabs(slabs_used, light.sinogram().width, light.sinogram().height);
  std::vector<Slab> doses = slabs(slabs_used, 256, 256);
  for (std::vector<Slab>* const side : {&rows, &doses}) {  // dark voxels would cost nothing
    for (Slab& slab : *side) std::fill(slab.values.begin(), slab.values.end(), 1.0F);
  }
  for (auto _ : state) apply(light, rows, doses);
  state.counters["updates"] =
      benchmark::Counter(256.0 * 256 * std::numbers::pi / 4 * 360 * slices * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

void adjoint(benchmark::State& state) {
  measure(state, [](const light::Operator& light, auto& rows, auto& doses) { light.adjoint(rows, doses); });
}

void forward(benchmark::State& state) {
  measure(state, [](const light::Operator& light, auto& rows, auto& doses) { light.forward(doses, rows); });
}

void table(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(light::VialRays(setup_of(state.range(0) != 0, 160)));
}

// {0: level, 1: climbing} x slices x {0: chief rays only, 1: of half angle 0.64 deg, held}.
BENCHMARK(adjoint)->ArgsProduct({{0, 1}, {64, 160}, {0, 1}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(forward)->ArgsProduct({{0, 1}, {64, 160}, {0, 1}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(table)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
BENCHMARK_MAIN();
