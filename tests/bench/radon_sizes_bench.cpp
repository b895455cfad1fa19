// SPDX-License-Identifier: GPL-3.0-or-later
// Footprints and Fourier slices over sides and numbers of slices: ms for forward and adjoint of a full turn of 360
// angles, folded (half a turn is worked out and mirrored), and what the choice between them expects of one thread. As
// in the tools 64 slices are a call; a single slice is lane 0 of a slab. With --all as the first argument also 256
// slices and a side of 2048, which takes minutes and 2 GB.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tomo/radon_choice.hpp"

using namespace vam;
using namespace vam::tomo;
using Slices = FourierRadon::Slices;

namespace {

constexpr int angles = 360;
constexpr int slabs_a_call = 4;

ParallelGeometry folded_turn(int n) {
  const int columns = static_cast<int>(std::ceil(n * std::numbers::sqrt2));
  return {n, n, columns, angles, 0.5 * (n - 1), 0.5 * (n - 1), 0, 2 * std::numbers::pi / angles, 0};
}

std::vector<Slab> filled(int count, int width, int height) {
  std::vector<Slab> slabs(static_cast<std::size_t>(count), Slab(width, height));
  std::minstd_rand random(1);
  for (Slab& slab : slabs) {
    for (float& value : slab.values) value = static_cast<float>(random() % 1024) / 1024.0F;
  }
  return slabs;
}

void radon(benchmark::State& state, int n, int slices, bool fourier, bool adjoint_direction) {
  const ParallelGeometry geometry = folded_turn(n);
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

void add(int n, int slices) {
  for (const bool fourier : {false, true}) {
    for (const bool adjoint_direction : {false, true}) {
      const std::string name = std::string(fourier ? "fourier" : "footprints") + "/folded/" + std::to_string(n) + "/" +
                               std::to_string(slices) + (adjoint_direction ? "_slices/adjoint" : "_slices/forward");
      benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { radon(state, n, slices, fourier, adjoint_direction); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
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
    for (const int slices : counts) add(n, slices);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
