// SPDX-License-Identifier: GPL-3.0-or-later
// The stated uncertainty of a reconstruction against repeated noisy views of an independent renderer.
#include "lib/metrology/bench_printer.hpp"
#include "metrology/ost/ost.hpp"
#include "metrology/ost/surface_uncertainty.hpp"
#include "metrology/ost/view_noise.hpp"
#include "oracle/bench_views.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "solid/voxel/isosurface.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

using Kind = oracle::Body::Kind;

oracle::ViewBench small_bench() {
  return {.columns = 120, .rows = 64, .pixel_mm = 0.15, .axis_column = 59.5, .axis_row = 31.5};
}

std::vector<oracle::Body> part() {
  return {{Kind::cylinder, {0.5, 0, 0}, {3, 0, 3}, 1}, {Kind::block, {4.5, 0.5, 0}, {0.8, 1, 2}, 1}};
}

// Read-out noise, and more where it is bright.
void add_noise(std::vector<CameraView>& views, double floor, double per_value, std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (CameraView& view : views) {
    for (float& value : view.image.values) {
      value += static_cast<float>(normal(random) * std::sqrt(floor + per_value * static_cast<double>(value)));
    }
  }
}

// Squared sums over the voxels of a shell between two radii, in the middle half of the heights.
double rms_between(const model::Volume& volume, double inner_mm, double outer_mm) {
  const model::Grid& g = volume.grid;
  double sum = 0;
  double count = 0;
  for (int k = g.nz / 4; k < 3 * g.nz / 4; ++k) {
    for (const auto [j, i] : indices(g.ny, g.nx)) {
      const double r = std::hypot(g.x_mm(i), g.y_mm(j));
      if (r < inner_mm || r >= outer_mm) continue;
      sum += std::pow(static_cast<double>(volume.slice(k)[std::ptrdiff_t{j} * g.nx + i]), 2);
      count += 1;
    }
  }
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("the noise of views is measured in them") {
  const oracle::ViewBench bench = small_bench();
  std::mt19937 random(5);
  for (const auto& [floor, per_value] : {std::pair{0.04, 0.0}, std::pair{0.01, 0.02}}) {
    auto views = views_of(bench, oracle::bench_views(bench, part(), {}, 24));
    add_noise(views, floor, per_value, random);
    const ViewNoise noise = view_noise(views);
    for (const double value : {0.0, 3.0, 5.0}) {
      const double sigma = std::sqrt(floor + per_value * value);
      MESSAGE("sigma ", sigma, " at ", value, ", measured ", noise.sigma(value));
      CHECK(noise.sigma(value) == doctest::Approx(sigma).epsilon(0.1));
    }
  }
}

TEST_CASE("the stated uncertainty is the scatter of repeated views") {
  // 16 turns of the same part, each with noise of its own; their standard deviation, voxel by voxel, over regions.
  // Its error is 1 / sqrt(2 * 15) = 18 % a voxel, which 10,000 voxels average out. Half of a turn has every other view
  // only, so that coverage counts.
  const oracle::ViewBench bench = small_bench();
  for (const bool sparse : {false, true}) {
    auto clean = views_of(bench, oracle::bench_views(bench, part(), {}, 90));
    if (sparse) {
      std::vector<CameraView> fewer;
      for (std::size_t i = 0; i < clean.size(); ++i) {
        if (i < 45 || i % 2 == 0) fewer.push_back(clean[i]);
      }
      clean = std::move(fewer);
    }
    const OstReconstructor rig(printer_of(bench), bench.pixel_mm, bench.columns, bench.rows, {bench.axis_column, 0},
                               {.non_negative = false, .axis_row = bench.axis_row});
    std::mt19937 random(9);
    constexpr int turns = 16;
    model::Volume sum;
    model::Volume squares;
    model::Volume stated;
    for (int turn = 0; turn < turns; ++turn) {
      auto views = clean;
      add_noise(views, 0.02, 0.01, random);
      const model::Volume volume = rig.reconstruct(views);
      if (turn == 0) {
        stated = rig.uncertainty(views).sigma;
        sum = {volume.grid, std::vector<float>(volume.values.size())};
        squares = sum;
      }
      for (std::size_t i = 0; i < volume.values.size(); ++i) {
        sum.values[i] += volume.values[i];
        squares.values[i] += volume.values[i] * volume.values[i];
      }
    }
    for (std::size_t i = 0; i < sum.values.size(); ++i) {
      const float mean = sum.values[i] / turns;
      squares.values[i] = std::sqrt(std::max(0.0F, squares.values[i] / turns - mean * mean) * turns / (turns - 1));
    }
    for (const auto& [inner, outer] :
         {std::pair{0.0, 1.5}, std::pair{1.5, 3.0}, std::pair{3.0, 4.5}, std::pair{4.5, 6.5}}) {
      const double seen = rms_between(squares, inner, outer);
      const double ratio = rms_between(stated, inner, outer) / seen;
      MESSAGE(std::string(sparse ? "half sparse, " : "even, "), inner, " to ", outer, " mm: scatter ", seen,
              ", stated ratio ", ratio);
      CHECK(ratio > 0.8);
      CHECK(ratio < 1.25);
    }
  }
}

TEST_CASE("the surface is as uncertain as repeated surfaces") {
  // Where repeated isosurfaces pass fixed points of the cylinder's side and upper face, away from the block: the RMS of
  // their standard deviations against that of the stated uncertainties of the first surface's vertices there.
  const oracle::ViewBench bench = small_bench();
  const auto clean = views_of(bench, oracle::bench_views(bench, part(), {}, 90));
  const OstReconstructor rig(printer_of(bench), bench.pixel_mm, bench.columns, bench.rows, {bench.axis_column, 0},
                             {.axis_row = bench.axis_row});
  constexpr int turns = 12;
  const std::array<std::vector<Vector3>, 2> places = [] {
    std::array<std::vector<Vector3>, 2> made;
    for (int n = 0; n < 100; ++n) {
      const double phi = 2 + 2.2 * n / 100;  // of the half away from the block
      made[0].push_back({0.5 + 3 * std::cos(phi), 3 * std::sin(phi), -2 + 4.0 * (n * 37 % 100) / 100});
      made[1].push_back({0.5 + 0.024 * n * std::cos(2.4 * n), 0.024 * n * std::sin(2.4 * n), 3});
    }
    return made;
  }();
  std::mt19937 random(11);
  std::array<std::vector<double>, 2> sums{std::vector<double>(100), std::vector<double>(100)};
  std::array<std::vector<double>, 2> squares = sums;
  std::array<double, 2> stated{};
  for (int turn = 0; turn < turns; ++turn) {
    auto views = clean;
    add_noise(views, 0.02, 0.01, random);
    const model::Volume volume = rig.reconstruct(views);
    const model::TriangleSoup mesh = solid::isosurface(volume, 0.5);
    const solid::Surface surface(mesh);
    for (std::size_t face = 0; face < 2; ++face) {
      for (std::size_t n = 0; n < 100; ++n) {
        const double d = surface.signed_distance(places[face][n]);
        sums[face][n] += d;
        squares[face][n] += d * d;
      }
    }
    if (turn > 0) continue;
    const std::vector<float> u = surface_uncertainty_mm(volume, rig.uncertainty(views), mesh.points);
    std::array<double, 2> counts{};
    for (std::size_t v = 0; v < u.size(); ++v) {
      const Vector3& p = mesh.points[v];
      const double r = std::hypot(p[0] - 0.5, p[1]);
      const bool side = std::abs(r - 3) < 0.15 && std::abs(p[2]) < 2 && p[0] < -0.7;
      const bool top = r < 2.4 && std::abs(p[2] - 3) < 0.2;
      if (!side && !top) continue;
      stated[side ? 0 : 1] += static_cast<double>(u[v]) * static_cast<double>(u[v]);
      counts[side ? 0 : 1] += 1;
    }
    for (std::size_t face = 0; face < 2; ++face) stated[face] = std::sqrt(stated[face] / counts[face]);
  }
  for (std::size_t face = 0; face < 2; ++face) {
    double variance = 0;
    for (std::size_t n = 0; n < 100; ++n) {
      variance += (squares[face][n] - sums[face][n] * sums[face][n] / turns) / (turns - 1) / 100;
    }
    const double ratio = stated[face] / std::sqrt(variance);
    MESSAGE(std::string(face == 0 ? "side" : "top"), ": scatter ", std::sqrt(variance), " mm, stated ratio ", ratio);
    // Between vertices the surface scatters less than at them, and clipped voxels less than they would.
    CHECK(ratio > 0.75);
    CHECK(ratio < 1.35);
  }
}
