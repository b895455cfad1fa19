// SPDX-License-Identifier: GPL-3.0-or-later
// Light that has width, in the vial's operator: judged by bundles that are followed ray by ray through frames that are
// held while the stage turns.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "lib/light/operator_checks.hpp"
#include "lib/light/vials.hpp"
#include "oracle/lens_dose.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

constexpr double turn = 2 * std::numbers::pi, deg = turn / 360;
constexpr int columns = 200, rows = 48;

/// A vial before a projector whose pixels are as large as the voxels, 0.13 mm.
VialSetup bench(int frames, double half_angle, double hold) {
  VialSetup setup;
  setup.view = {std::nullopt, 1.0, 0.0, {{12.7, 1.53}}, std::nullopt};
  setup.projector = optics::centred_detector(columns, 0.13);
  setup.turn = {frames, 0, turn / frames};
  setup.absorption_per_mm = 0.05;
  setup.radius_mm = 7.6;
  setup.grid = model::centred_grid(117, 117, rows, 0.13, -0.5 * (rows - 1) * 0.13);
  setup.hold_rad = hold;
  setup.half_angle_rad = setup.rows_half_angle_rad = half_angle;
  return setup;
}

oracle::LensBench same(const VialSetup& setup, int rings, int holds) {
  oracle::LensBench bench;
  bench.radius = setup.view.shells[0].radius_mm;
  bench.resin = setup.view.shells.back().index;
  bench.bath = setup.view.bath_index;
  bench.window = bench.bath == 1 ? 0 : setup.view.window_mm;
  bench.column_throw = setup.view.lens_mm.value_or(0);
  bench.row_throw = setup.view.rows_lens_mm.value_or(0);
  bench.focus = setup.focus_mm;
  bench.pixel = setup.projector.pixel_mm;
  bench.absorption = setup.absorption_per_mm;
  bench.frames = setup.turn.rows;
  if (setup.half_angle_rad > 0) bench.pupil = oracle::round_pupil(setup.half_angle_rad, rings);
  if (setup.hold_rad > 0) bench.hold = oracle::held(setup.hold_rad, holds);
  return bench;
}

/// Sharp light as an optimiser finds it: filtered projections of discs that end at rows, without what is negative.
double discs(const VialSetup& setup, int frame, int row, int column) {
  const double b = (column + 0.5) * 0.13 / 12.7;
  if (std::abs(b) >= 1) return 0;
  const double theta = setup.turn.step_rad * frame + std::asin(b) - std::asin(b / 1.53);
  double sum = 0;
  for (int i = 0; i < 6; i++) {
    if ((row + 40 + 4 * i) % 16 > 8) continue;
    const double middle = i == 0 ? 0 : 4.2 * std::cos(theta - turn * i / 5), radius = i == 0 ? 2 : 1.2;
    const double off = std::abs(b * 12.7 / 1.53 - middle);
    sum += off < radius ? 1 : 1 - off / std::sqrt(off * off - radius * radius);
  }
  return std::max(0.0, sum);
}

/// The operator's dose of that light.
std::vector<Slab> dose_of(const VialSetup& setup) {
  const VialOperator light(setup);
  const std::size_t count = rows / lanes;
  std::vector<Slab> images = slabs(count, light.image().width, light.image().height);
  for (int row = 0; row < rows; ++row) {
    for (int a = 0; a < setup.turn.rows; ++a) {
      for (int c = 0; c < columns; ++c) {
        images[row / lanes].at(c, a)[row % lanes] =
            static_cast<float>(discs(setup, a, row - rows / 2, c - columns / 2));
      }
    }
  }
  std::vector<Slab> g = slabs(count, light.sinogram().width, light.sinogram().height);
  for (std::size_t s = 0; s < count; ++s) light.collapse(images[s], g[s]);
  std::vector<Slab> dose = slabs(count, setup.grid.nx, setup.grid.ny);
  light.adjoint(g, dose);
  return dose;
}

struct Place {
  int i, j, k;
};

/// Across the circle and along z.
std::vector<Place> places(int count) {
  std::vector<Place> all;
  for (int v = 0; v < count; ++v) {
    const double r = 6.6 / 0.13 * std::sqrt((v + 0.5) / count), angle = 2.4 * v;
    all.push_back(
        {static_cast<int>(58 + r * std::cos(angle)), static_cast<int>(58 + r * std::sin(angle)), 16 + 5 * v % 17});
  }
  return all;
}

/// What the oracle finds in the mean over a voxel, at points^3 places in it.
double mean_dose(const VialSetup& setup, const oracle::LensBench& lens, const Place& at, int points) {
  const auto frames = [&](int frame, int row, int column) { return discs(setup, frame, row, column); };
  const auto place = [&](double middle, int n) { return middle + 0.13 * ((n % points + 0.5) / points - 0.5); };
  double sum = 0;
  for (int p = 0; p < points * points * points; ++p) {
    sum += oracle::lens_dose(lens, frames,
                             {place(setup.grid.x_mm(at.i), p), place(setup.grid.y_mm(at.j), p / points),
                              place(setup.z_scale * setup.grid.z_mm(at.k), p / points / points)});
  }
  return sum / (points * points * points);
}

struct Errors {
  double with = 0, without = 0;  // RMS over the voxels, of the largest dose: of the operator, and of one without width
};

Errors errors(const VialSetup& setup, const oracle::LensBench& lens, int voxels, int points) {
  VialSetup thin = setup;
  thin.hold_rad = thin.half_angle_rad = thin.rows_half_angle_rad = 0;
  const std::vector<Slab> with = dose_of(setup), without = dose_of(thin);
  double square = 0, thin_square = 0, largest = 0;
  for (const Place& at : places(voxels)) {
    const double want = mean_dose(setup, lens, at, points);
    const auto miss = [&](const std::vector<Slab>& dose) {
      return static_cast<double>(dose[at.k / lanes].at(at.i, at.j)[at.k % lanes]) - want;
    };
    largest = std::max(largest, want);
    square += miss(with) * miss(with);
    thin_square += miss(without) * miss(without);
    MESSAGE("" << at.i << " " << at.j << " " << at.k << " " << want << " " << miss(with) << " " << miss(without));
  }
  return {std::sqrt(square / voxels) / largest, std::sqrt(thin_square / voxels) / largest};
}

}  // namespace

TEST_CASE("light of a lens, and of frames held in a vial that turns, is that of rays followed one by one") {
  struct Case {
    double half_angle_deg, steps_held, focus_mm, error;  // of the largest dose, most of it the oracle's own samples
  };
  for (const auto& [half_angle, steps, focus, error] :
       {Case{0, 1, 0, 1.5e-3}, {0.64, 0, 0, 3e-3}, {1.5, 1, 0, 6e-3}, {0.64, 0, 3, 3e-3}}) {
    CAPTURE(half_angle);
    VialSetup setup = bench(60, half_angle * deg, steps * turn / 60);
    setup.focus_mm = focus;
    const Errors found = errors(setup, same(setup, 3, half_angle > 0 ? 4 : 8), 10, half_angle > 1 ? 2 : 3);
    CHECK(found.with < error);
    CHECK(found.without > 4 * error);
  }
}

TEST_CASE("light without width is what it was, to the byte, and light that has some is not") {
  const VialSetup setup = bench(24, 0, 0);
  VialSetup wide = setup, aimed = setup;
  aimed.focus_mm = 3;
  wide.hold_rad = setup.turn.step_rad;
  const std::vector<Slab> dose = dose_of(setup), same = dose_of(aimed), other = dose_of(wide);
  for (std::size_t s = 0; s < dose.size(); ++s) {
    CHECK(dose[s].values == same[s].values);
    CHECK(dose[s].values != other[s].values);
  }
}

TEST_CASE("A and A* of light that has width are adjoint") {
  VialSetup setup = bench(24, 1.5 * deg, turn / 24);
  CHECK(parts::adjoint_error_of_volume(VialOperator(setup), 3) < 1e-5);
  setup.view = parts::walled_vial;
  setup.view.rows_lens_mm = 60;
  setup.focus_mm = -4;
  setup.grid.nz = 43;
  constexpr std::size_t few = 1009;
  for (const std::size_t every : {std::size_t{1}, few})
    CHECK(parts::adjoint_error_of_volume(VialOperator(setup), 3, every) < 1e-5);
  for (int k = 0; k < 24; ++k) setup.poses.push_back({15.0 * k, 0.3 * std::cos(k), 0.2, 0.1 * k, model::Moves::part});
  for (const std::size_t every : {std::size_t{1}, few})
    CHECK(parts::adjoint_error_of_volume(VialOperator(setup), 3, every) < 1e-5);
  setup.rows_half_angle_rad = 0;
  setup.view.rows_lens_mm.reset();
  setup.poses.clear();
  CHECK(parts::adjoint_error(VialOperator(setup)) < 1e-5);
}

TEST_CASE("light that spreads over too many voxels along z is an error") {
  VialSetup setup = bench(24, 5 * deg, 0);
  setup.focus_mm = 100;
  CHECK(fault_of([&] { VialOperator light(setup); }) == Fault::data);
}

TEST_CASE("kernels of rows are even, positive and as wide as asked") {
  const RowSpread spread(4);
  for (const double rows_wide : {0.0, 0.1, 0.37, 1.0, 2.6, 4.0}) {
    const auto weights = spread.weights(spread.step(rows_wide, 1.0 / 6));
    double sum = static_cast<double>(weights[0]), variance = 0;
    for (std::size_t k = 1; k < weights.size(); ++k) {
      CHECK(weights[k] > 0);
      sum += 2 * static_cast<double>(weights[k]);
      variance += 2 * static_cast<double>(weights[k]) * static_cast<double>(k * k);
    }
    CHECK(sum == doctest::Approx(1));
    CHECK(std::sqrt(variance) == doctest::Approx(rows_wide).epsilon(0.08));
  }
}
