// SPDX-License-Identifier: GPL-3.0-or-later
// A print of a million vertices against a reference of a million triangles: the limit is 10 s on two cores for all of
// vam-sdf, from alignment to the distance of every vertex.
#include <benchmark/benchmark.h>

#include <cmath>

#include "lib/meshes.hpp"
#include "metrology/compare/deviation.hpp"
#include "solid/mesh/align.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace {

using vam::Vector3;
using vam::model::TriangleSoup;

// A lumpy ball without symmetry, turned by `turn_rad` about z.
TriangleSoup lumpy(int rings, double growth_mm, double turn_rad) {
  return vam::test::globe(rings, [&](double t, double p) -> Vector3 {
    const double r = 6 + growth_mm + std::sin(t) * (std::sin(3 * t + 1) * std::cos(2 * p) + 0.5 * std::cos(p + 2));
    return {r * std::sin(t) * std::cos(p + turn_rad), r * std::sin(t) * std::sin(p + turn_rad), 1.3 * r * std::cos(t)};
  });
}

const TriangleSoup& print() {
  static const TriangleSoup mesh = lumpy(707, 0.05, 2.5);  // 1.001 million vertices
  return mesh;
}

const TriangleSoup& reference() {
  static const TriangleSoup mesh = lumpy(501, 0, 0);  // 1.002 million triangles
  return mesh;
}

void whole(benchmark::State& state) {
  double rms = 0;
  for (auto _ : state) {
    const vam::solid::Surface surface(reference());
    const auto alignment = vam::solid::align(print(), reference(), surface, {});
    TriangleSoup aligned = print();
    for (auto& point : aligned.points) point = alignment.transform(point);
    const auto found = vam::metrology::compare(vam::metrology::measure(aligned, reference(), surface, 200000));
    benchmark::DoNotOptimize(surface.signed_distances(aligned.points).data());
    rms = found.print_to_design.rms_mm;
  }
  state.counters["rms_mm"] = rms;
}
BENCHMARK(whole)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

void tree(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(vam::solid::Surface(reference()).closest({9, 0, 0}).triangle);
}
BENCHMARK(tree)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

void alignment(benchmark::State& state) {
  const vam::solid::Surface surface(reference());
  for (auto _ : state) benchmark::DoNotOptimize(vam::solid::align(print(), reference(), surface, {}).rms_mm);
}
BENCHMARK(alignment)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

void million_distances(benchmark::State& state) {
  const vam::solid::Surface surface(reference());
  for (auto _ : state) benchmark::DoNotOptimize(surface.signed_distances(print().points).data());
}
BENCHMARK(million_distances)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
