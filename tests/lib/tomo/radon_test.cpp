// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/radon.hpp"

#include <cstring>

#include "base/compute/parallel.hpp"
#include "lib/tomo/radon_cases.hpp"
#include "oracle/strip_radon.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::tomo;
using namespace radon_cases;

namespace {

Slab random_slab(int width, int height, unsigned seed) {
  Slab slab(width, height);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  for (float& value : slab.values) value = uniform(random);
  return slab;
}

std::vector<Slab> random_slabs(int count, int width, int height, unsigned seed) {
  std::vector<Slab> slabs;
  slabs.reserve(count);
  for (int i = 0; i < count; ++i) slabs.push_back(random_slab(width, height, seed + static_cast<unsigned>(i)));
  return slabs;
}

std::vector<double> lane_of(const Slab& slab, int lane) {
  std::vector<double> values;
  for (std::size_t p = 0; p < slab.values.size(); p += lanes) {
    values.push_back(static_cast<double>(slab.values[p + static_cast<std::size_t>(lane)]));
  }
  return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// Attenuation, too.
const std::vector<Case> cases = cases_and({
    {"attenuated", {41, 50, 70, 21, 20, 24.5, 0.05, 2 * pi / 21, 0.02}},
    {"attenuated, negative, narrow detector", {64, 33, 40, 16, 30, 10, 0, 2 * pi / 16, -0.03}},
});

}  // namespace

TEST_CASE("forward and adjoint agree with clipped squares") {
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const ParallelGeometry& g = c.geometry;
    vam::oracle::StripRadon slow{g.nx, g.ny, g.columns, g.axis_x, g.axis_y, {}, g.alpha_per_px};
    for (int a = 0; a < g.angles; ++a) slow.theta_rad.push_back(g.angle_start_rad + a * g.angle_step_rad);
    const std::vector<Slab> images = random_slabs(1, g.nx, g.ny, 1);
    const std::vector<Slab> sinograms = random_slabs(1, g.columns, g.angles, 2);
    std::vector<Slab> projected{Slab(g.columns, g.angles)};
    std::vector<Slab> dose{Slab(g.nx, g.ny)};
    forward(g, images, projected);
    adjoint(g, sinograms, dose);
    // About 100 float terms of size 1, each position known to 1e-5 px.
    CHECK(largest_difference(lane_of(projected[0], 3), slow.forward(lane_of(images[0], 3))) < 1e-4);
    CHECK(largest_difference(lane_of(dose[0], 15), slow.adjoint(lane_of(sinograms[0], 15))) < 1e-4);
  }
}

TEST_CASE("adjoint identity <Ax, y> = <x, A*y>") {
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const ParallelGeometry& g = c.geometry;
    const auto x = random_slabs(3, g.nx, g.ny, 3);
    const auto y = random_slabs(3, g.columns, g.angles, 30);
    std::vector<Slab> ax(3, Slab(g.columns, g.angles));
    std::vector<Slab> aty(3, Slab(g.nx, g.ny));
    forward(g, x, ax);
    adjoint(g, y, aty);
    for (std::size_t s = 0; s < 3; ++s) {
      const double scale = std::sqrt(dot(ax[s], ax[s]) * dot(y[s], y[s]));
      CHECK(std::abs(dot(ax[s], y[s]) - dot(x[s], aty[s])) < 1e-5 * scale);
    }
  }
}

TEST_CASE("both directions are partitions of unity") {
  const ParallelGeometry g = full_turn(50, 75, 36);
  std::vector<Slab> ones{Slab(50, 50)};
  std::vector<Slab> sinogram{Slab(75, 36)};
  std::fill(ones[0].values.begin(), ones[0].values.end(), 1.0F);
  forward(g, ones, sinogram);
  for (int a = 0; a < 36; ++a) {
    double mass = 0;
    for (int c = 0; c < 75; ++c) mass += static_cast<double>(*sinogram[0].at(c, a));
    CHECK(mass == doctest::Approx(2500).epsilon(1e-5));  // float sums
  }
  std::fill(sinogram[0].values.begin(), sinogram[0].values.end(), 1.0F);
  adjoint(g, sinogram, ones);
  for (const float value : ones[0].values) CHECK(value == doctest::Approx(36).epsilon(1e-5));
}

TEST_CASE("an off-centre disc has the projections of its chords") {
  const Disc disc;
  std::vector<Slab> sinogram{Slab(Disc::columns, Disc::angles)};
  forward(disc.g, disc.image, sinogram);
  disc.judge(sinogram[0]);
}

TEST_CASE("the same bytes for one and two threads, and for any number of neighbours in a call") {
  const ParallelGeometry g = full_turn(70, 101, 26);
  const auto x = random_slabs(7, g.nx, g.ny, 5);
  const auto y = random_slabs(7, g.columns, g.angles, 50);
  std::vector<Slab> ax(7, Slab(g.columns, g.angles));
  std::vector<Slab> aty(7, Slab(g.nx, g.ny));
  vam::set_threads(1);
  forward(g, x, ax);
  adjoint(g, y, aty);
  vam::set_threads(2);
  std::vector<Slab> ax2(7, Slab(g.columns, g.angles));
  std::vector<Slab> aty2(7, Slab(g.nx, g.ny));
  forward(g, x, ax2);
  adjoint(g, y, aty2);
  vam::set_threads(0);
  for (std::size_t s = 0; s < 7; ++s) {
    CHECK(ax[s].values == ax2[s].values);
    CHECK(aty[s].values == aty2[s].values);
    std::vector<Slab> alone_sinogram{Slab(g.columns, g.angles)};
    std::vector<Slab> alone_image{Slab(g.nx, g.ny)};
    forward(g, std::span(x).subspan(s, 1), alone_sinogram);
    adjoint(g, std::span(y).subspan(s, 1), alone_image);
    CHECK(alone_sinogram[0].values == ax[s].values);
    CHECK(alone_image[0].values == aty[s].values);
  }
}

TEST_CASE("all instruction sets agree within rounding") {
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const ParallelGeometry& g = c.geometry;
    const auto x = random_slabs(5, g.nx, g.ny, 6);
    const auto y = random_slabs(5, g.columns, g.angles, 60);
    std::vector<Slab> ax(5, Slab(g.columns, g.angles));
    std::vector<Slab> aty(5, Slab(g.nx, g.ny));
    forward(g, x, ax, vam::Simd::baseline);
    adjoint(g, y, aty, vam::Simd::baseline);
    for (const vam::Simd level : {vam::Simd::avx2, vam::Simd::avx512}) {
      if (level > vam::simd_level()) {
        MESSAGE("skipped: this processor lacks SIMD level " << static_cast<int>(level));
        continue;
      }
      std::vector<Slab> ax_level(5, Slab(g.columns, g.angles));
      std::vector<Slab> aty_level(5, Slab(g.nx, g.ny));
      forward(g, x, ax_level, level);
      adjoint(g, y, aty_level, level);
      for (std::size_t s = 0; s < 5; ++s) {
        // Fused and separate multiply-adds move a footprint by at most 1e-5 px; about 100 terms of size 1.
        CHECK(largest_difference(lane_of(ax[s], 7), lane_of(ax_level[s], 7)) < 1e-4);
        CHECK(largest_difference(lane_of(aty[s], 7), lane_of(aty_level[s], 7)) < 1e-4);
      }
    }
  }
}

TEST_CASE("wrong shapes and overflowing attenuation are errors") {
  ParallelGeometry g = full_turn(20, 31, 8);
  const std::vector<Slab> image{Slab(20, 20)};
  std::vector<Slab> wrong{Slab(30, 8)};
  std::vector<Slab> right{Slab(31, 8)};
  CHECK_THROWS_AS(forward(g, image, wrong), vam::Error);
  g.alpha_per_px = 10;
  CHECK_THROWS_AS(forward(g, image, right), vam::Error);
}
