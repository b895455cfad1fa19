// SPDX-License-Identifier: GPL-3.0-or-later
// Giga-updates a second (pixels x angles x slices / time) of forward and adjoint, 512 x 512, 360 angles.
//   full: a full turn, where both fold opposite angles into one; the updates counted are those asked for, twice those
//   done. half: the same number of angles over half a turn, where nothing folds: the kernels' own speed.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tomo/radon.hpp"

using namespace vam;
using namespace vam::tomo;

namespace {

constexpr int n = 512;
constexpr int angles = 360;
constexpr int columns = 725;

std::vector<Slab> filled(int count, int width, int height) {
  std::vector<Slab> slabs(static_cast<std::size_t>(count), Slab(width, height));
  std::minstd_rand random(1);
  for (Slab& slab : slabs) {
    for (float& value : slab.values) value = static_cast<float>(random() % 1024) / 1024.0F;
  }
  return slabs;
}

void radon(benchmark::State& state, bool adjoint_direction, double turn_rad, int slabs, double alpha, vam::Simd level) {
  const ParallelGeometry geometry{n, n, columns, angles, 0.5 * (n - 1), 0.5 * (n - 1), 0, turn_rad / angles, alpha};
  std::vector<Slab> images = filled(slabs, n, n);
  std::vector<Slab> sinograms = filled(slabs, columns, angles);
  for (auto _ : state) {
    if (adjoint_direction) {
      adjoint(geometry, sinograms, images, level);
    } else {
      forward(geometry, images, sinograms, level);
    }
    benchmark::ClobberMemory();
  }
  const double updates = 1.0 * n * n * angles * slabs * lanes * static_cast<double>(state.iterations());
  state.counters["GUPS"] = benchmark::Counter(updates / 1e9, benchmark::Counter::kIsRate);
}

void add(const std::string& name, double turn_rad, int slabs, double alpha, vam::Simd level) {
  if (level > vam::simd_level()) return;
  for (const bool adjoint_direction : {false, true}) {
    benchmark::RegisterBenchmark(
        ((adjoint_direction ? "adjoint/" : "forward/") + name).c_str(),
        [=](benchmark::State& state) { radon(state, adjoint_direction, turn_rad, slabs, alpha, level); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
}

}  // namespace

int main(int argc, char** argv) {
  constexpr double pi = std::numbers::pi;
  const vam::Simd best = vam::simd_level();
  add("half/64_slices", pi, 4, 0, best);
  add("full/64_slices", 2 * pi, 4, 0, best);
  add("half/16_slices", pi, 1, 0, best);
  add("attenuated/64_slices", 2 * pi, 4, 0.002, best);
  add("half/64_slices/avx2", pi, 4, 0, vam::Simd::avx2);
  add("half/64_slices/baseline", pi, 4, 0, vam::Simd::baseline);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
