// SPDX-License-Identifier: GPL-3.0-or-later
// Forward and adjoint of 360 angles. full, half, attenuated: giga-updates a second (pixels x angles x slices / time) of
// 512 x 512; opposite angles of a full turn are folded into one, twice the updates done are counted; over half a turn
// nothing folds: the kernels' own speed. folded: footprints and Fourier slices over sides and numbers of slices, a full
// turn in ms, and what the choice between them expects of one thread. 64 slices are a call, as in the tools; a single
// one is lane 0 of a slab. With --all first also 256 slices and a side of 2048, which takes minutes and 2 GB.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tomo/radon.hpp"
#include "tomo/radon_choice.hpp"

using namespace vam;
using namespace vam::tomo;
using Slices = FourierRadon::Slices;

namespace {

constexpr int angles = 360;
constexpr int slabs_a_call = 4;

ParallelGeometry turn_of(int n, double turn_rad, double alpha) {
  const int columns = static_cast<int>(std::ceil(n * std::numbers::sqrt2));
  return {n, n, columns, angles, 0.5 * (n - 1), 0.5 * (n - 1), 0, turn_rad / angles, alpha};
}

std::vector<Slab> filled(int count, int width, int height) {
  std::vector<Slab> slabs(static_cast<std::size_t>(count), Slab(width, height));
  std::minstd_rand random(1);
  for (Slab& slab : slabs) {
    for (float& value : slab.values) value = static_cast<float>(random() % 1024) / 1024.0F;
  }
  return slabs;
}

void speed(benchmark::State& state, bool adjoint_direction, double turn_rad, int slabs, double alpha, Simd level) {
  constexpr int n = 512;
  const ParallelGeometry geometry = turn_of(n, turn_rad, alpha);
  std::vector<Slab> images = filled(slabs, n, n);
  std::vector<Slab> sinograms = filled(slabs, geometry.columns, angles);
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

void folded(benchmark::State& state, int n, int slices, bool fourier, bool adjoint_direction) {
  const ParallelGeometry geometry = turn_of(n, 2 * std::numbers::pi, 0);
  const int slabs = (slices + lanes - 1) / lanes;
  const int a_call = std::min(slabs, slabs_a_call);
  const Slices kind = slices == 1 ? Slices::one : Slices::all;
  const auto transform = fourier ? std::make_unique<FourierRadon>(geometry, kind) : nullptr;
  std::vector<Slab> images = filled(a_call, n, n);
  std::vector<Slab> sinograms = filled(a_call, geometry.columns, angles);
  for (auto _ : state) {
    for (int done = 0; done < slabs; done += a_call) {
      if (adjoint_direction) {
        fourier ? transform->adjoint(sinograms, images) : adjoint(geometry, sinograms, images);
      } else {
        fourier ? transform->forward(images, sinograms) : forward(geometry, images, sinograms);
      }
      benchmark::ClobberMemory();
    }
  }
  const RadonCost cost = radon_cost(geometry, static_cast<std::size_t>(a_call), kind);
  const double expected_ns = (fourier ? cost.fourier : cost.footprints) * slabs / a_call / 2;
  state.counters["expected_ms"] = expected_ns / 1e6;
}

void add(const std::string& name, bool adjoint_direction, const std::function<void(benchmark::State&)>& measured) {
  const std::string whole = (adjoint_direction ? "adjoint/" : "forward/") + name;
  benchmark::RegisterBenchmark(whole.c_str(), measured)->Unit(benchmark::kMillisecond)->UseRealTime();
}

void add_speed(const std::string& name, double turn_rad, int slabs, double alpha, Simd level) {
  if (level > simd_level()) return;
  for (const bool back : {false, true}) {
    add(name, back, [=](benchmark::State& state) { speed(state, back, turn_rad, slabs, alpha, level); });
  }
}

void add_folded(int n, int slices) {
  for (const bool fourier : {false, true}) {
    const std::string name = std::string("folded/") + (fourier ? "fourier/" : "footprints/") + std::to_string(n) + "/" +
                             std::to_string(slices) + "_slices";
    for (const bool back : {false, true}) {
      add(name, back, [=](benchmark::State& state) { folded(state, n, slices, fourier, back); });
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool all = argc > 1 && std::string_view(argv[1]) == "--all";
  std::vector<int> sides{128, 256, 512, 1024};
  std::vector<int> counts{1, 16, 64};
  if (all) {
    sides.push_back(2048);
    counts.push_back(256);
    std::rotate(argv + 1, argv + 2, argv + argc);
    --argc;
  }
  for (const int n : sides) {
    for (const int slices : counts) add_folded(n, slices);
  }
  constexpr double pi = std::numbers::pi;
  const Simd best = simd_level();
  add_speed("half/64_slices", pi, 4, 0, best);
  add_speed("full/64_slices", 2 * pi, 4, 0, best);
  add_speed("half/16_slices", pi, 1, 0, best);
  add_speed("attenuated/64_slices", 2 * pi, 4, 0.002, best);
  add_speed("half/64_slices/avx2", pi, 4, 0, Simd::avx2);
  add_speed("half/64_slices/baseline", pi, 4, 0, Simd::baseline);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
