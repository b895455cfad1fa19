// SPDX-License-Identifier: GPL-3.0-or-later
// Repairing and voxelizing a mesh of a million triangles at 512^3: the limit is 3 s on two cores for both together.
#include <benchmark/benchmark.h>

#include "oracle/meshes.hpp"
#include "oracle/polygon_soup.hpp"
#include "solid/mesh/repair.hpp"
#include "solid/voxel/placement.hpp"
#include "solid/voxel/voxelize.hpp"

using namespace vam;

namespace {

constexpr int bands = 501;  // 4 * 501 * 500 = 1,002,000 triangles
const model::Grid grid = model::centred_grid(512, 512, 512, 1, -255.5);

const model::TriangleSoup& stl() {
  static const model::TriangleSoup mesh = vam::oracle::unwelded(vam::oracle::lumpy_sphere(225, bands, 0.08));
  return mesh;
}

const model::TriangleSoup& repaired() {
  static const model::TriangleSoup mesh = [] {
    model::TriangleSoup copy = stl();
    (void)solid::repair(copy, "bench");
    return copy;
  }();
  return mesh;
}

void repair(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    model::TriangleSoup copy = stl();
    state.ResumeTiming();
    benchmark::DoNotOptimize(solid::repair(copy, "bench"));
  }
}
BENCHMARK(repair)->Unit(benchmark::kMillisecond)->UseRealTime();

// What the library would take for a part of the work.
void cgal_polygon_soup(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(vam::oracle::oriented_by_cgal(stl()));
}
BENCHMARK(cgal_polygon_soup)->Unit(benchmark::kMillisecond)->UseRealTime();

void voxelize(benchmark::State& state, solid::Fill fill) {
  for (auto _ : state) {
    double sum = 0;
    (void)solid::voxelize(repaired(), grid, fill, solid::Bounds{},
                          [&](int, int, const float* slices) { sum += slices[0]; });
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK_CAPTURE(voxelize, exact, solid::Fill::exact)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(voxelize, vote, solid::Fill::vote)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
