// SPDX-License-Identifier: GPL-3.0-or-later
// Projections for printers off their settings: scenarios are what those printers do, and the prints hold.
#include "optimize/methods/private/robust.hpp"

#include "base/compute/parallel.hpp"
#include "base/text/json.hpp"
#include "light/operators/make_operator.hpp"
#include "light/simulation/simulation.hpp"
#include "model/tolerances.hpp"
#include "optimize/run/yield.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

constexpr int size = 32;
constexpr int slices = 20;
constexpr int angles = 48;
constexpr double middle = 0.5 * (size - 1);
const model::Grid grid = model::centred_grid(size, size, slices, 0.3, -2.85);
const model::Circle circle{middle, middle, 0.5 * size};
const model::Tolerances coarse{2, 0.01, 1, 0.5, 3, 0.1};

light::VialSetup setup_of(const model::DeviatingPrinter& off) {
  light::VialSetup setup = light::vial_setup(off.printer, grid, angles, circle.radius * grid.voxel_mm);
  setup.angle_offset_rad = off.angle_offset_rad;
  setup.hold_rad = 0;  // 48 frames, shown while the stage stands
  return setup;
}

const TolerantPrinter tolerant{{},
                               coarse,
                               [](const model::Printer& printer) { return setup_of({.printer = printer}); },
                               [](const model::Resin& resin) { return resin.psf_mm / grid.voxel_mm; }};

/// A ring with a bar across it, round about the axis and in the middle slices.
void target(int k, int count, float* out) {
  for (int n = k; n < k + count; ++n) {
    for (const auto [y, x] : indices(size, size)) {
      const double r = std::hypot(x - middle, y - middle);
      const bool solid = (r > 7 && r < 11) || (r < 9 && std::abs(x - middle) < 2);
      *out++ = solid && n >= 4 && n < 16 ? 1.0F : 0.0F;
    }
  }
}

VolumeTask make_task(std::vector<Image>& frames, bool robust) {
  VolumeTask task;
  task.source.slices = slices;
  task.source.target = target;
  task.circle = circle;
  task.limits = {.iterations = 24, .until = {}, .patience = 0};
  task.make = [robust](double) { return robust ? make_robust({}) : make_method("apg", {}); };
  if (robust) task.scenarios = [](std::span<const Slab>) { return corner_scenarios(tolerant, {}); };
  task.write = [&frames](int, const Image& image) { frames.push_back(image); };
  return task;
}

struct Printing {
  std::vector<Image> frames;
  Trials trials;
};

Printing print(bool robust) {
  Printing made;
  const VolumeTask task = make_task(made.frames, robust);
  optimise(task, *light::make_operator(setup_of({})));
  const Trial trial{.printer = tolerant, .grid = grid, .printers = 12};
  made.trials = run_trials(trial, task, made.frames);
  return made;
}

double least_margin(const Trials& trials) {
  double least = trials.nominal.margin();
  for (const auto& single : trials.singles) least = std::min({least, single.minus.margin(), single.plus.margin()});
  return least;
}

}  // namespace

TEST_CASE("a scenario's gradient is the transpose of its dose") {
  const auto nominal = light::make_operator(setup_of({}));
  const Scenarios scenarios(*nominal, corner_scenarios(tolerant, {}), slices);
  std::vector<Slab> g = slabs(2, nominal->sinogram().width, nominal->sinogram().height);
  std::vector<Slab> x = slabs(2, size, size);
  for (auto* images : {&g, &x}) {
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t i = 0; i < (*images)[s].values.size(); ++i) {
        const bool used = s * lanes + i % lanes < slices;
        (*images)[s].values[i] = used ? static_cast<float>(i * 7919 % 101) / 101.0F : 0.0F;
      }
    }
  }
  const auto dot = [](const std::vector<Slab>& a, const std::vector<Slab>& b) {
    double sum = 0;
    for (std::size_t s = 0; s < a.size(); ++s) {
      for (std::size_t i = 0; i < a[s].values.size(); ++i) {
        sum += static_cast<double>(a[s].values[i]) * static_cast<double>(b[s].values[i]);
      }
    }
    return sum;
  };
  for (int one = 0; one < scenarios.count(); ++one) {
    std::vector<Slab> dose = slabs(2, size, size), back = slabs(2, g[0].width, g[0].height);
    scenarios.adjoint(one, g, dose);
    scenarios.forward(one, x, back);
    CHECK(dot(x, dose) == doctest::Approx(dot(back, g)).epsilon(1e-5));  // single precision
  }
}

TEST_CASE("every pair has its turn once a round") {
  const auto nominal = light::make_operator(setup_of({}));
  const Scenarios scenarios(*nominal, corner_scenarios(tolerant, {}), slices);
  for (const int round : {0, 1, 2}) {
    std::vector<int> seen;
    for (int i = 0; i < scenarios.count() / 2; ++i) {
      const auto [one, other] = scenarios.drawn(round * scenarios.count() / 2 + i);
      CHECK(other == one + 1);
      seen.push_back(one);
    }
    std::sort(seen.begin(), seen.end());
    for (std::size_t i = 0; i < seen.size(); ++i) CHECK(seen[i] == 2 * static_cast<int>(i));
  }
}

TEST_CASE("prints made for tolerances keep a wider margin under each of them") {
  const Printing plain = print(false);
  const Printing robust = print(true);
  CHECK(robust.trials.nominal.wrong == 0);
  CHECK(least_margin(robust.trials) > least_margin(plain.trials));
  CHECK(robust.trials.good >= plain.trials.good);
  CHECK(robust.trials.printers == 12);
  const Json json = report(robust.trials);
  CHECK(json["single"].size() == 6);
  CHECK(json["yield"] == static_cast<double>(robust.trials.good) / 12);
}

TEST_CASE("projections made for tolerances do not depend on the number of threads") {
  const auto made = [](int count) {
    set_threads(count);
    std::vector<Image> frames;
    VolumeTask task = make_task(frames, true);
    task.limits.iterations = 14;
    optimise(task, *light::make_operator(setup_of({})));
    set_threads(0);
    return frames;
  };
  const auto one = made(1);
  const auto two = made(2);
  REQUIRE(one.size() == two.size());
  for (std::size_t k = 0; k < one.size(); ++k) CHECK(one[k].values == two[k].values);
}

TEST_CASE("where the window is wider than the part can have, its doses miss both ends and still print") {
  std::vector<Image> frames;
  VolumeTask task = make_task(frames, true);
  const double threshold = task.demands.window.threshold();
  task.demands.window = {0.5 * threshold, 1.5 * threshold};
  const auto metrics = optimise(task, *light::make_operator(setup_of({}))).metrics;
  CHECK(metrics.min_part > threshold);
  CHECK(metrics.max_void < threshold);
}
