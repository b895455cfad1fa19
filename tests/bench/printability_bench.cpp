// SPDX-License-Identifier: GPL-3.0-or-later
// What prints, with which method, and how fast: prints a table. Arguments: parts SIZE, target METHOD, stack, osmo or
// certify SIZE ITERATIONS; all without.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "lib/optimize/parts.hpp"
#include "lib/optimize/printed_part.hpp"
#include "optimize/run/certify.hpp"
#include "oracle/part_2d.hpp"

namespace {

using namespace vam;

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Iterations that keep within 120 projections, the start and apg's and descent's search for a step included.
struct Budget {
  std::string method;
  int iterations;
  int projections;
};

const std::vector<Budget>& budgets() {
  static const std::vector<Budget> all = [] {
    const std::vector<Budget> known{{"fbp", 0, 2},   {"dose-norm", 1, 4}, {"cal", 59, 120}, {"osmo", 29, 119},
                                    {"pm", 58, 120}, {"bclp", 58, 120},   {"apg", 51, 120}, {"minimax", 34, 118}};
    std::vector<Budget> budgets;
    for (const auto& entry : optimize::method_table()) {
      const auto there =
          std::find_if(known.begin(), known.end(), [&](const Budget& b) { return b.method == entry.name; });
      budgets.push_back(there != known.end() ? *there : Budget{entry.name, 59, 120});  // two a step, as most
    }
    return budgets;
  }();
  return all;
}

void print(const std::string& problem, const Budget& budget, const model::DoseMetrics& m, double time, int slices) {
  std::printf("%-22s %-10s %4d projections  VER %.1e  PW %+.4f  IoU %.5f  %7.2f s a slice\n", problem.c_str(),
              budget.method.c_str(), budget.projections, m.ver, m.pw, m.iou, time / slices);
  std::fflush(stdout);
}

void target(const std::string& method) {
  const int size = 512;
  const auto slice = vam::oracle::resolution_target(size);
  for (const auto& budget : budgets()) {
    if (!method.empty() && method != budget.method) continue;
    optimize::Demands demands;
    demands.curve =
        optimize::CureCurve::logistic(demands.window.threshold(), optimize::method_entry(budget.method).softness);
    model::DoseMetrics m;
    const double time =
        seconds([&] { m = parts::run({slice}, size, 360, budget.method, {}, budget.iterations, demands)[0]; });
    print("resolution 512 x 512", budget, m, time, 1);
  }
}

/// The resolution target in one of 64 places: mirrored in x, in y, along the diagonal, and moved by up to 7 pixels.
std::vector<float> target_in_place(const std::vector<float>& target, int size, int place) {
  std::vector<float> moved(target.size(), 0.0F);
  const auto at = [size](int x, int y) { return static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x); };
  const int shift = place / 8;
  for (int y = 0; y < size; ++y) {
    for (int x = shift; x < size; ++x) {
      const int u = (place & 1) != 0 ? size - 1 - (x - shift) : x - shift;
      const int v = (place & 2) != 0 ? size - 1 - y : y;
      moved[at(x, y)] = (place & 4) != 0 ? target[at(v, u)] : target[at(u, v)];
    }
  }
  return moved;
}

/// 64 different slices of one pass.
void stack() {
  const int size = 512;
  const auto target = vam::oracle::resolution_target(size);
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < 64; ++k) slices.push_back(target_in_place(target, size, k));
  std::vector<model::DoseMetrics> m;
  const Budget& budget = budgets().back();
  const double time = seconds([&] { m = parts::run(slices, size, 360, budget.method, {}, budget.iterations); });
  print("64 resolution slices", budget,
        *std::min_element(m.begin(), m.end(), [](auto& a, auto& b) { return a.pw < b.pw; }), time, 64);
}

/// One osmo iteration on 315^3 voxels: five passes of at most 64 slices, start left out.
void osmo() {
  const int size = 315;
  double time = 0;
  for (int first = 0; first < size; first += slices_per_pass) {
    std::vector<std::vector<float>> slices;
    for (int k = first; k < std::min(size, first + slices_per_pass); ++k) {
      slices.push_back(vam::oracle::gyroid(size, 3, 0.02 * k, 0.4));
    }
    const auto made = parts::parallel_light(size, 360);
    const vam::light::Operator& light = *made;
    const auto all = parts::stacked(slices);
    const auto problem =
        parts::make_problem(all.data(), static_cast<int>(slices.size()), size, size, parts::circle(size), {});
    const auto method = optimize::make_method("osmo", {});
    optimize::Iterate state;
    method->start(problem, light, state);
    time += seconds([&] { method->step(problem, light, state); });
  }
  std::printf("osmo, 31 Mvoxels, 360 angles, one iteration: %.2f s\n", time);
}

/// How near the bound on any light comes to the best light of one slice.
void certified(int size, int iterations) {
  const int angles = size * 45 / 32;  // 360 of 256
  const auto light = parts::parallel_light(size, angles);
  const std::vector<std::pair<const char*, std::vector<float>>> slices{
      {"resolution", vam::oracle::resolution_target(size)},
      {"gyroid", vam::oracle::gyroid(size, 3, 0.7, 0.4)},
      {"wheel", vam::oracle::wheel(size)},
      {"disc grid", vam::oracle::disc_grid(size, size / 256.0)}};
  for (const auto& [name, slice] : slices) {
    const auto problem = parts::make_problem(slice.data(), 1, size, size, parts::circle(size), {});
    optimize::Iterate state;
    const double before = seconds([&] {
      const auto method = optimize::make_method("apg", {});
      run_method(*method, problem, *light, {.iterations = 60, .until = {}, .patience = 0}, state);
    });
    optimize::Certificate proof;
    const double time = seconds([&] { proof = optimize::certify(problem, *light, state.g, iterations); });
    std::printf(
        "%-10s %d^2 x %d  max void / min part %.4f, at least %.4f: gap %.2f %%  %d iterations, %.1f s (+ %.1f)\n", name,
        size, angles, proof.reached, proof.least, 100 * (1 - proof.least / proof.reached), iterations, time, before);
    std::fflush(stdout);
  }
}

struct Row {
  std::string method;
  bool resampled;
};

/// Test parts in the vial, optimised and judged by chief rays; the last row went by way of parallel light.
void printed(int size) {
  const model::Printer printer;
  const std::vector<Row> rows{{"fbp", false}, {"dose-norm", false}, {"auto", false}, {"auto", true}};
  for (const auto& shape : parts::printed_shapes()) {
    const parts::Part part = parts::make_part(shape, size);
    for (const Row& row : rows) {
      const parts::Light light = parts::make_light(part, printer, 360, row.method, row.resampled);
      const model::DoseMetrics m = parts::judge(part, printer, light);
      std::printf("%-16s %3d x %3d x %3d  %-10s %-9s %3d iterations  VER %.1e  PW %+.4f  IoU %.5f  %7.2f s\n",
                  shape.c_str(), part.grid.nx, part.grid.ny, part.grid.nz, row.method.c_str(),
                  row.resampled ? "resampled" : "vial", light.iterations, m.ver, m.pw, m.iou, light.seconds);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  if (only.empty() || only == "parts") printed(argc > 2 ? std::atoi(argv[2]) : 128);
  if (only.empty() || only == "target") target(argc > 2 ? argv[2] : "");
  if (only.empty() || only == "stack") stack();
  if (only.empty() || only == "osmo") osmo();
  if (only.empty() || only == "certify")
    certified(argc > 2 ? std::atoi(argv[2]) : 256, argc > 3 ? std::atoi(argv[3]) : 1200);
  return 0;
}
