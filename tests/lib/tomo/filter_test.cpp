// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/filter.hpp"

#include "base/compute/parallel.hpp"
#include "testing.hpp"
#include "tomo/negative_values.hpp"
#include "tomo/private/fft.hpp"

using namespace vam;
using namespace vam::tomo;

namespace {

constexpr double pi = std::numbers::pi;

Slab random_slab(int width, int height) {
  Slab slab(width, height);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  for (float& value : slab.values) value = uniform(random);
  return slab;
}

/// Gain at the frequency `fraction` of Nyquist.
double gain(const Filter& filter, double fraction) {
  const auto& gains = filter.gains();
  return gains[std::lround(fraction * static_cast<double>(gains.size() - 1))];
}

}  // namespace

TEST_CASE("the ramp is the direct convolution with the band-limited kernel of [KS88 chapter 3]") {
  const int columns = 57;
  const Slab before = random_slab(columns, 5);
  Slab after = before;
  Filter(columns, {}).apply(after);
  for (const auto [a, lane, c] : indices(5, lanes, columns)) {
    double want = 0.25 * static_cast<double>(before.at(c, a)[lane]);
    for (int d = 0; d < columns; ++d) {
      const int n = c - d;
      if (n % 2 != 0) want -= static_cast<double>(before.at(d, a)[lane]) / (pi * pi * n * n);
    }
    CHECK(static_cast<double>(after.at(c, a)[lane]) == doctest::Approx(want).epsilon(2e-6).scale(1));  // float FFT
  }
}

TEST_CASE("windows have their shape at half the cutoff and their edge") {
  const auto ratio = [](FilterWindow window, double cutoff, double fraction) {
    return gain(Filter(500, {window, cutoff, 0, 0}), fraction) / gain(Filter(500, {}), fraction);
  };
  CHECK(ratio(FilterWindow::shepp_logan, 1, 0.5) == doctest::Approx(std::sin(pi / 4) / (pi / 4)));
  CHECK(ratio(FilterWindow::cosine, 1, 0.5) == doctest::Approx(std::cos(pi / 4)));
  CHECK(ratio(FilterWindow::hamming, 1, 0.5) == doctest::Approx(0.54));
  CHECK(ratio(FilterWindow::hann, 1, 0.5) == doctest::Approx(0.5));
  CHECK(ratio(FilterWindow::gaussian, 0.5, 0.5) == doctest::Approx(std::exp(-1)));
  CHECK(ratio(FilterWindow::exponential, 0.25, 0.5) == doctest::Approx(std::exp(-2)));
  CHECK(ratio(FilterWindow::hann, 0.5, 0.25) == doctest::Approx(0.5));
  CHECK(ratio(FilterWindow::ram_lak, 0.5, 0.45) == doctest::Approx(1));
  CHECK(ratio(FilterWindow::ram_lak, 0.5, 0.55) == 0);
}

TEST_CASE("the mean of the ramp is positive and tiny, and the floor lifts it") {
  const Filter ramp(512, {});
  CHECK(gain(ramp, 0) > 0);
  CHECK(gain(ramp, 0) < 1e-3);
  CHECK(gain(ramp, 1) == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(gain(ramp, 0.5) == doctest::Approx(0.25).epsilon(1e-3));
  const Filter floored(512, {FilterWindow::ram_lak, 1, 0.05, 0});
  CHECK(gain(floored, 0) == 0.025);
  CHECK(gain(floored, 0.5) == gain(ramp, 0.5));
}

TEST_CASE("the exponential ramp blocks |k| < alpha and passes the rest") {
  const double alpha = 0.4;  // = 0.127 of Nyquist (k = pi)
  const Filter filter(2000, {FilterWindow::ram_lak, 1, 0, alpha});
  for (const double fraction : {0.0, 0.05, 0.1}) CHECK(std::abs(gain(filter, fraction)) < 1e-3);
  for (const double fraction : {0.16, 0.3, 0.7})
    CHECK(gain(filter, fraction) == doctest::Approx(fraction / 2).epsilon(0.01));
}

TEST_CASE("filter none does not change a sinogram") {
  const Slab before = random_slab(40, 3);
  Slab after = before;
  Filter(40, {FilterWindow::none, 1, 0, 0}).apply(after);
  CHECK(after.values == before.values);
}

TEST_CASE("filtering gives the same bytes for any number of threads") {
  Slab one = random_slab(129, 61);
  Slab two = one;
  const Filter filter(129, {FilterWindow::hann, 0.8, 0, 0});
  vam::set_threads(1);
  filter.apply(one);
  vam::set_threads(2);
  filter.apply(two);
  vam::set_threads(0);
  CHECK(one.values == two.values);
}

TEST_CASE("names and limits") {
  for (std::size_t i = 0; i < window_names().size(); ++i) {
    CHECK(window_from_name(window_names()[i]) == static_cast<FilterWindow>(i));
  }
  CHECK_THROWS_AS(static_cast<void>(window_from_name("hanning")), vam::Error);
  CHECK_THROWS_AS(Filter(10, {FilterWindow::hann, 0, 0, 0}), vam::Error);
  CHECK_THROWS_AS(Filter(10, {FilterWindow::hann, 1, 2, 0}), vam::Error);
  Slab slab(11, 1);
  CHECK_THROWS_AS(Filter(10, {}).apply(slab), vam::Error);
}

TEST_CASE("a ceiling caps the gain; members given by position keep their meaning") {
  vam::tomo::FilterSpec spec{vam::tomo::FilterWindow::ram_lak, 1, 0, 0};
  CHECK(spec.ceiling == 1);
  spec.ceiling = 0.4;
  const vam::tomo::Filter filter(64, spec);
  const auto& gains = filter.gains();
  CHECK(gains.back() == doctest::Approx(0.2));                             // 0.4 of the 1/2 at the highest frequency
  CHECK(gains[gains.size() / 4] == doctest::Approx(0.125).epsilon(0.02));  // below it the ramp
  spec.floor = 0.5;
  CHECK_THROWS_AS(vam::tomo::Filter(64, spec), vam::Error);
}

TEST_CASE("windows have their shape between half the cutoff and their edges") {
  const Filter ramp(500, {});
  for (const double fraction : {0.125, 0.375, 0.75, 0.875}) {
    CAPTURE(fraction);
    const auto ratio = [&](FilterWindow window) {
      return gain(Filter(500, {window, 1, 0, 0}), fraction) / gain(ramp, fraction);
    };
    CHECK(ratio(FilterWindow::hamming) == doctest::Approx(0.54 + 0.46 * std::cos(pi * fraction)).epsilon(1e-5));
    CHECK(ratio(FilterWindow::hann) == doctest::Approx(0.5 + 0.5 * std::cos(pi * fraction)).epsilon(1e-3));
    CHECK(ratio(FilterWindow::cosine) == doctest::Approx(std::cos(pi * fraction / 2)).epsilon(1e-3));
  }
}

TEST_CASE("a transform is the shortest of 2^n, 3 2^n and 5 2^n that is long enough") {
  CHECK(fft_length(1) == 1);
  CHECK(fft_length(2) == 2);
  CHECK(fft_length(3) == 3);
  CHECK(fft_length(4) == 4);
  CHECK(fft_length(5) == 5);
  CHECK(fft_length(7) == 8);
  CHECK(fft_length(9) == 10);
  CHECK(fft_length(11) == 12);
  CHECK(fft_length(13) == 16);
  CHECK(fft_length(17) == 20);
  CHECK(fft_length(21) == 24);
  CHECK(fft_length(25) == 32);
}

TEST_CASE("negative intensities are offset, then clipped") {
  Slab slab(3, 1);
  for (int i = 0; i < 3 * lanes; ++i) slab.at(0, 0)[i] = static_cast<float>(i % 3) - 1;  // -1, 0, 1
  CHECK(lowest(slab) == -1);
  raise_and_clip(slab, 0.5F, 0);
  for (int i = 0; i < 3 * lanes; ++i) CHECK(slab.at(0, 0)[i] == (i % 3 == 0 ? 0.0F : static_cast<float>(i % 3) - 0.5F));
}
