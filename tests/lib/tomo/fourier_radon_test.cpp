// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/fourier_radon.hpp"

#include "base/compute/parallel.hpp"
#include "lib/tomo/radon_cases.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::tomo;
using namespace radon_cases;
using Slices = FourierRadon::Slices;

namespace {

const std::vector<Case> cases = cases_and({{"more tiles than one", full_turn(150, 213, 16)}});

int used(Slices slices) { return slices == Slices::one ? 1 : lanes; }

Slab noise(int width, int height, Slices slices, unsigned seed) {
  Slab slab(width, height);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  for (std::size_t p = 0; p < slab.values.size(); p += lanes) {
    for (int lane = 0; lane < used(slices); ++lane) slab.values[p + static_cast<std::size_t>(lane)] = uniform(random);
  }
  return slab;
}

/// A Gaussian blob, in another place in each lane.
Slab blobs(int width, int height, Slices slices, double sigma) {
  Slab slab(width, height);
  for (const auto [y, x, lane] : indices(height, width, used(slices))) {
    const double from_x = x - width * (0.4 + 0.01 * lane);
    const double from_y = y - height * (0.6 - 0.015 * lane);
    slab.at(x, y)[lane] = static_cast<float>(std::exp(-(from_x * from_x + from_y * from_y) / (2 * sigma * sigma)));
  }
  return slab;
}

double largest(const Slab& a) {
  double most = 0;
  for (const float value : a.values) most = std::max(most, std::abs(static_cast<double>(value)));
  return most;
}

Slab difference(Slab a, const Slab& b) {
  for (std::size_t i = 0; i < a.values.size(); ++i) a.values[i] -= b.values[i];
  return a;
}

Slab projected(const FourierRadon& radon, const ParallelGeometry& g, const Slab& image) {
  Slab sinogram(g.columns, g.angles);
  radon.forward({&image, 1}, {&sinogram, 1});
  return sinogram;
}

Slab lit(const FourierRadon& radon, const ParallelGeometry& g, const Slab& sinogram) {
  Slab image(g.nx, g.ny);
  radon.adjoint({&sinogram, 1}, {&image, 1});
  return image;
}

}  // namespace

TEST_CASE("Fourier slices: adjoint identity <Ax, y> = <x, A*y>") {
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const ParallelGeometry& g = c.geometry;
    for (const Slices slices : {Slices::all, Slices::one}) {
      const FourierRadon radon(g, slices);
      const Slab x = noise(g.nx, g.ny, slices, 1);
      const Slab y = noise(g.columns, g.angles, slices, 2);
      const Slab ax = projected(radon, g, x);
      const double scale = std::sqrt(dot(ax, ax) * dot(y, y));
      CHECK(std::abs(dot(ax, y) - dot(x, lit(radon, g, y))) < 1e-6 * scale);  // the same weights, summed in float
    }
  }
}

TEST_CASE("Fourier slices are those of the footprints where the image is smooth") {
  ParallelGeometry beside{150, 131, 200, 90, 70.3, 68.9, 0.1, 2 * pi / 90, 0};
  ParallelGeometry half{131, 150, 117, 45, 65, 74.5, 0.3, -pi / 45, 0};  // fewer columns than needed
  for (const ParallelGeometry& g : {full_turn(150, 213, 90), beside, half}) {
    CAPTURE(g.columns);
    for (const Slices slices : {Slices::all, Slices::one}) {
      const FourierRadon radon(g, slices);
      // Near an axis the footprints' aliases beyond one cycle per pixel are missing: 2.3 k^2 of what has k cycles per
      // pixel, so 2.3 / (2 pi sigma)^2 of a blob.
      for (const auto& [sigma, tolerance] : {std::pair{10.0, 1e-3}, {3.0, 8e-3}}) {
        CAPTURE(sigma);
        const Slab image = blobs(g.nx, g.ny, slices, sigma);
        Slab sinogram(g.columns, g.angles);
        forward(g, {&image, 1}, {&sinogram, 1});
        CHECK(largest(difference(projected(radon, g, image), sinogram)) < tolerance * largest(sinogram));
        const Slab light = blobs(g.columns, g.angles, slices, sigma);
        Slab dose(g.nx, g.ny);
        adjoint(g, {&light, 1}, {&dose, 1});
        CHECK(largest(difference(lit(radon, g, light), dose)) < tolerance * largest(dose));
      }
    }
  }
}

TEST_CASE("of noise the Fourier slices leave out what is above one cycle per pixel") {
  const ParallelGeometry g = full_turn(128, 182, 90);
  const FourierRadon radon(g);
  const Slab image = noise(g.nx, g.ny, Slices::all, 3);
  Slab sinogram(g.columns, g.angles);
  forward(g, {&image, 1}, {&sinogram, 1});
  const Slab left_out = difference(projected(radon, g, image), sinogram);
  // White noise through sinc(k) sinc(k c) sinc(k s): 1e-3 of the power lies beyond.
  CHECK(std::sqrt(dot(left_out, left_out) / dot(sinogram, sinogram)) < 0.05);
}

TEST_CASE("Fourier slices: an off-centre disc has the projections of its chords") {
  const Disc disc;
  for (const Slices slices : {Slices::all, Slices::one})
    disc.judge(projected(FourierRadon(disc.g, slices), disc.g, disc.image[0]));
}

TEST_CASE("Fourier slices: the same bytes for one and two threads, and for any number of neighbours in a call") {
  const ParallelGeometry g = full_turn(150, 213, 26);
  for (const Slices slices : {Slices::all, Slices::one}) {
    const FourierRadon radon(g, slices);
    const std::vector<Slab> x{noise(g.nx, g.ny, slices, 5), noise(g.nx, g.ny, slices, 6)};
    const std::vector<Slab> y{noise(g.columns, g.angles, slices, 7), noise(g.columns, g.angles, slices, 8)};
    std::vector<Slab> ax(2, Slab(g.columns, g.angles));
    std::vector<Slab> aty(2, Slab(g.nx, g.ny));
    set_threads(1);
    radon.forward(x, ax);
    radon.adjoint(y, aty);
    set_threads(2);
    for (std::size_t s = 0; s < 2; ++s) {
      CHECK(projected(radon, g, x[s]).values == ax[s].values);
      CHECK(lit(radon, g, y[s]).values == aty[s].values);
    }
    set_threads(0);
  }
}

TEST_CASE("Fourier slices: all instruction sets agree within rounding") {
  const ParallelGeometry g = full_turn(70, 101, 26);
  for (const Slices slices : {Slices::all, Slices::one}) {
    const Slab x = noise(g.nx, g.ny, slices, 9);
    const Slab y = noise(g.columns, g.angles, slices, 10);
    const FourierRadon plain(g, slices, Simd::baseline);
    for (const Simd level : {Simd::avx2, Simd::avx512}) {
      if (level > simd_level()) {
        MESSAGE("skipped: this processor lacks SIMD level " << static_cast<int>(level));
        continue;
      }
      const FourierRadon radon(g, slices, level);
      // A few thousand float terms.
      CHECK(largest(difference(projected(radon, g, x), projected(plain, g, x))) < 1e-5 * 100);
      CHECK(largest(difference(lit(radon, g, y), lit(plain, g, y))) < 1e-5 * 100);
    }
  }
}

TEST_CASE("Fourier slices: wrong shapes and absorbers are errors") {
  const ParallelGeometry g = full_turn(20, 31, 8);
  const FourierRadon radon(g);
  const std::vector<Slab> image{Slab(20, 20)};
  std::vector<Slab> wrong{Slab(30, 8)};
  CHECK_THROWS_AS(radon.forward(image, wrong), Error);
  CHECK_THROWS_AS(FourierRadon(g.with_alpha(0.01)), Error);
}
