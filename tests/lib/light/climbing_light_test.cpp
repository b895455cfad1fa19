// SPDX-License-Identifier: GPL-3.0-or-later
#include "lib/light/operator_checks.hpp"
#include "lib/light/vial_dose.hpp"
#include "optics/writable_radius.hpp"
#include "oracle/skew_dose.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

/// A tall vial before a short lens that stands below the part: rays climb by a tenth of the way and more.
struct Bench {
  VialSetup setup;
  vam::oracle::SkewDose slow;
};

Bench bench(double lens_mm, double first_slice_mm, double absorption_per_mm, double bath, double window_mm) {
  constexpr int size = 20;
  constexpr int slices = 10;
  constexpr int rows = 20;
  constexpr double voxel = 0.4;
  constexpr double scale = 0.95;
  Bench b;
  b.setup.view = {lens_mm, bath, window_mm, {{12.7, 1.47}, {11.5, 1.53}}, lens_mm};
  b.setup.projector = optics::centred_detector(48, 0.4);
  b.setup.turn = {30, 0, 2 * std::numbers::pi / 30};
  b.setup.absorption_per_mm = absorption_per_mm;
  b.setup.grid = model::centred_grid(size, size, slices, voxel, first_slice_mm);
  b.setup.z_scale = scale;
  b.setup.rows = rows;
  b.setup.first_row_mm = first_slice_mm - 5 * voxel;
  b.slow.bench.lens_distance = lens_mm;
  b.slow.bench.bath = bath;
  b.slow.bench.window = bath == 1 ? 0 : window_mm;
  b.slow.bench.cylinders = {{12.7L, 1.47L}, {11.5L, 1.53L}};
  b.slow.pixel = 0.4;
  b.slow.columns = 48;
  b.slow.rows = rows;
  b.slow.first_row = b.setup.first_row_mm;
  b.slow.rays = 6;
  b.slow.absorption = absorption_per_mm;
  b.slow.angles = 30;
  b.slow.size = size;
  b.slow.slices = slices;
  b.slow.voxel = voxel;
  b.slow.height = scale * voxel;
  b.slow.first_slice = scale * first_slice_mm;
  return b;
}

struct Difference {
  double rms;   // over the dose's RMS
  double mean;  // of all, relative
};

/// Opaque, off the axis and not symmetric.
bool opaque(int i, int j, int slice) { return i >= 6 && i < 12 && j >= 8 && j < 10 && slice >= 4 && slice < 8; }

std::vector<Slab> insert_of(const Bench& b) {
  Slab insert(b.slow.size, b.slow.size);
  for (const auto [j, i, k] : indices(b.slow.size, b.slow.size, b.slow.slices))
    insert.at(i, j)[k] = opaque(i, j, k) ? 1.0F : 0.0F;
  return {insert};
}

/// Where every voxel sees rows above and below: four slices away from the light's ends.
Difference compare(const Bench& b, const std::function<double(int, int, int)>& intensity,
                   std::span<const Slab> inserts = {}) {
  std::vector<Image> rows(static_cast<std::size_t>(b.slow.rows), Image(b.slow.columns, b.slow.angles));
  for (const auto [r, a, c] : indices(b.slow.rows, b.slow.angles, b.slow.columns)) {
    rows[r](c, a) = static_cast<float>(intensity(c, r, a));
  }
  const auto slices = static_cast<std::size_t>(b.slow.slices);
  const std::vector<Image> fast = parts::doses_of(VialOperator(b.setup, inserts), rows, slices);
  const auto slow = vam::oracle::skew_dose(b.slow, intensity);
  const double reach = optics::reach_mm(b.setup.view);
  double error = 0, square = 0, sum = 0, want = 0;
  const auto at = [&](std::size_t k, int i, int j) {
    return slow.dose[(k * static_cast<std::size_t>(b.slow.size) + static_cast<std::size_t>(j)) *
                         static_cast<std::size_t>(b.slow.size) +
                     static_cast<std::size_t>(i)];
  };
  // Blocks of eight voxels: rays are counted in or out of a voxel as a whole, some 200 of them a voxel and angle.
  for (std::size_t k = 0; k < slices; k += 2) {
    for (int j = 0; j < b.slow.size; j += 2) {
      for (int i = 0; i < b.slow.size; i += 2) {
        if (std::hypot(b.setup.grid.x_mm(i + 0.5), b.setup.grid.y_mm(j + 0.5)) > 0.9 * reach) continue;
        if (!inserts.empty() && opaque(i, j, static_cast<int>(k))) continue;
        double here = 0, there = 0;
        for (int v = 0; v < 8; ++v) {
          const std::size_t slice = k + static_cast<std::size_t>(v / 4);
          here += static_cast<double>(fast[slice](i + v % 2, j + v / 2 % 2));
          there += at(slice, i + v % 2, j + v / 2 % 2);
        }
        error += (here - there) * (here - there);
        square += there * there;
        sum += here;
        want += there;
      }
    }
  }
  return {std::sqrt(error / square), sum / want - 1};
}

/// Light that varies over some millimetres, without symmetry.
double smooth(int column, int row, int angle) {
  return 1.2 + 0.6 * std::sin(0.14 * column + 0.21 * angle) + 0.5 * std::cos(0.3 * row + 0.1 * column);
}

/// Every frame elsewhere: two turns of ten angles, in which the vial or the part circles and rises.
Bench posed(Bench b, model::Moves moves, double radius_mm, double lift_mm) {
  constexpr int frames = 20;
  b.setup.turn = {frames, 0, 2 * std::numbers::pi / 10};
  b.slow.angles = frames;
  b.slow.turns = 2;
  for (int k = 0; k < frames; ++k) {
    const double phi = 0.7 + 0.9 * k;
    const model::Pose pose{36.0 * k, radius_mm * std::cos(phi), radius_mm * std::sin(phi),
                           lift_mm * (2.0 * k / (frames - 1) - 1), moves};
    b.setup.poses.push_back(pose);
    b.slow.poses.push_back({pose.dx_mm, pose.dy_mm, pose.dz_mm, moves == model::Moves::vial});
  }
  return b;
}

/// Of ten slices and twenty rows.
double adjoint_error(const VialOperator& light) {
  std::vector<Slab> f{parts::noise(light.object(), 1)};
  for (std::size_t i = 0; i < f[0].values.size(); ++i) f[0].values[i] *= i % lanes < 10 ? 1.0F : 0.0F;
  const std::vector<Slab> g{parts::noise(light.sinogram(), 2), parts::noise(light.sinogram(), 3)};
  std::vector<Slab> projected = slabs(2, light.sinogram().width, light.sinogram().height);
  std::vector<Slab> dose = slabs(1, light.object().width, light.object().height);
  light.forward(f, projected);
  light.adjoint(g, dose);
  double given = 0, size = 0, light_size = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    given += parts::dot(projected[s], g[s]);
    size += parts::dot(projected[s], projected[s]);
    light_size += parts::dot(g[s], g[s]);
  }
  return std::abs(given - parts::dot(f[0], dose[0])) / std::sqrt(size * light_size);
}

}  // namespace

TEST_CASE("skew rays leave the dose deposited ray by ray") {
  for (const Bench& b : {bench(90, -1.8, 0, 1, 0), bench(60, 6, 0.08, 1, 0), bench(92, 15, 0.05, 1.4, 20)}) {
    const Difference d = compare(b, smooth);
    // 6 x 6 rays a pixel: the oracle's own grain, which falls to 0.002 to 0.003 with 16 x 16.
    CHECK(d.rms < 7e-3);
    CHECK(std::abs(d.mean) < 2e-3);
  }
}

TEST_CASE("projections that jump from pixel to pixel are read over the pixel's own width") {
  std::mt19937 random(7);
  std::vector<double> noise(48 * 20 * 30);
  for (double& v : noise) v = static_cast<double>(random() % 1000) / 500;
  const auto rough = [&](int c, int r, int a) { return noise[(a * 20 + r) * 48 + c]; };
  const Difference d = compare(bench(90, -1.8, 0, 1, 0), rough);
  CHECK(d.rms < 7e-3);  // no more than of smooth light: the grain again
  CHECK(std::abs(d.mean) < 2e-3);
}

TEST_CASE("in every pose of vial and part the dose is that deposited ray by ray") {
  const Bench still = bench(90, -1.8, 0.05, 1, 0);
  const Bench short_lens = bench(60, 6, 0.08, 1, 0);
  const Bench bath = bench(92, 15, 0.05, 1.4, 20);
  for (const Bench& b : {posed(still, model::Moves::part, 0.6, 0.8), posed(short_lens, model::Moves::vial, 0.9, -0.4),
                         posed(bath, model::Moves::vial, 0.9, 0.8)}) {
    const Difference d = compare(b, smooth);
    CHECK(d.rms < 7e-3);               // the oracle's own grain, as without poses
    CHECK(std::abs(d.mean) < 2.5e-3);  // 2.0e-3 of them are there without poses, too
  }
}

// Rays of the operator have no width: a column's shadow begins and ends as a whole, in 20 x 20 voxels around an insert
// of 6 x 2. That costs up to 0.017 RMS and 0.006 in the mean, at the shadow's edges.
TEST_CASE("an insert's shadow agrees with voxel-by-voxel ray traversal, for skew rays and in every pose") {
  const Bench still = bench(90, -1.8, 0.05, 1, 0);
  const Bench short_lens = bench(60, 6, 0.08, 1, 0);
  for (Bench b : {still, short_lens, posed(still, model::Moves::part, 0.6, 0.8),
                  posed(short_lens, model::Moves::vial, 0.9, -0.4), posed(still, model::Moves::vial, 0.9, 0.8)}) {
    b.slow.opaque = opaque;
    b.slow.rays = 4;  // their grain is small beside that
    const std::vector<Slab> inserts = insert_of(b);
    const Difference d = compare(b, smooth, inserts);
    CHECK(d.rms < 2e-2);
    CHECK(std::abs(d.mean) < 1e-2);
    CHECK(adjoint_error(VialOperator(b.setup, inserts)) < 1e-5);
  }
  Bench without = still;
  without.slow.opaque = opaque;
  CHECK(compare(without, smooth).rms > 0.1);  // there is light
}

TEST_CASE("a displaced vial, a displaced part and neither have three different doses") {
  const Bench b = posed(bench(90, -1.8, 0.05, 1, 0), model::Moves::vial, 0.9, 0);
  const auto doses = [&](const VialSetup& setup) {
    std::vector<Image> rows(20, Image(48, 20));
    for (const auto [r, a, c] : indices(20, 20, 48)) rows[r](c, a) = static_cast<float>(smooth(c, r, a));
    return parts::doses_of(VialOperator(setup), rows, 10);
  };
  VialSetup part = b.setup;
  for (model::Pose& pose : part.poses) pose.moves = model::Moves::part;
  VialSetup none = b.setup;
  for (model::Pose& pose : none.poses) pose = {pose.angle_deg};
  const auto difference = [](const std::vector<Image>& a, const std::vector<Image>& c) {
    double most = 0;
    for (std::size_t i = 0; i < a[5].size(); ++i) {
      most = std::max(most, static_cast<double>(std::abs(a[5].values[i] - c[5].values[i])));
    }
    return most;
  };
  const auto vial_doses = doses(b.setup);
  CHECK(difference(vial_doses, doses(part)) > 0.1);  // of a dose of some 10
  CHECK(difference(vial_doses, doses(none)) > 0.1);
}

TEST_CASE("the dose at the reach is the same whether the resin beyond it is computed or not") {
  Bench b = bench(60, 0, 0.2, 1, 0);
  const double reach = optics::reach_mm(b.setup.view);
  const double edge = 0.01 * reach;
  b.setup.grid = {8, 1, 10, edge, {0.94 * reach, 0, -4.5 * edge}};
  b.setup.first_row_mm = -9.5 * edge;
  const auto dose = [&](double radius_mm) {
    VialSetup setup = b.setup;
    setup.radius_mm = radius_mm;
    const std::vector<Image> rows(20, Image(48, 30, 1.0F));
    return parts::doses_of(VialOperator(setup), rows, 10)[5];
  };
  const Image within = dose(0.9999 * reach);
  const Image beyond = dose(optics::resin_radius_mm(b.setup.view));
  for (int i = 0; b.setup.grid.x_mm(i) + 0.5 * edge < reach; ++i) {  // no part of the voxel is beyond it
    CAPTURE(i);
    CHECK(within(i, 0) > 0);
    CHECK(within(i, 0) == doctest::Approx(beyond(i, 0)).epsilon(1e-6));  // rays of the same points: a float's rounding
  }
}
