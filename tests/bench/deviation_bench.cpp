// A print of a million vertices against a reference of a million triangles: the bar is 10 s on two cores for all of
// vam-sdf, from alignment to the distance of every vertex.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "metrology/deviation.hpp"
#include "solid/align.hpp"

namespace {

using vam::model::TriangleSoup;

// A lumpy ball without symmetry, turned by `turn_rad` about z: 2 rings (rings + 1) points, 4 rings (rings - 1)
// triangles.
TriangleSoup lumpy(int rings, double growth_mm, double turn_rad) {
  TriangleSoup mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const double t = std::numbers::pi * i / rings;
      const double p = 2 * std::numbers::pi * j / around;
      const double r = 6 + growth_mm + std::sin(t) * (std::sin(3 * t + 1) * std::cos(2 * p) + 0.5 * std::cos(p + 2));
      mesh.points.push_back(
          {r * std::sin(t) * std::cos(p + turn_rad), r * std::sin(t) * std::sin(p + turn_rad), 1.3 * r * std::cos(t)});
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j;
      const int b = i * around + (j + 1) % around;
      if (i > 0) mesh.triangles.push_back({a, a + around, b});
      if (i + 1 < rings) mesh.triangles.push_back({b, a + around, b + around});
    }
  }
  return mesh;
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
    const auto found = vam::metrology::compare(aligned, reference(), surface, 200000);
    benchmark::DoNotOptimize(surface.signed_distances(aligned.points).data());
    rms = found.print_to_reference.rms_mm;
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
