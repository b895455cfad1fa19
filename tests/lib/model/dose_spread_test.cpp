// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusion of the dose, against the sum of what many flashes leave.
#include "model/dose/dose_spread.hpp"

#include <limits>

#include "testing.hpp"

using namespace vam;

namespace {

constexpr double diffusion_mm2_s = 1e-4;
constexpr double print_s = 180;

/// What a line of light leaves at the end of the print and the dark after it, summed over flashes: from one to the next
/// a part of it dies where it is, and the rest spreads.
struct Flashes {
  double lost_per_s;  // 1 / lifetime
  double dark_s = 0;

  /// The sum of measure(sigma) over all that the flashes leave, over the light.
  template <class Measure>
  double mean(const Measure& measure) const {
    constexpr int flashes = 1200;
    constexpr double step_s = print_s / flashes;
    const int end = flashes + static_cast<int>(dark_s / step_s);
    double sum = 0;
    for (int flash = 0; flash < flashes; ++flash) {
      double left = 1;
      for (int step = 0; flash + step < end; ++step) {
        const double dies = flash + step + 1 < end ? left * -std::expm1(-lost_per_s * step_s) : left;
        sum += dies * measure(std::sqrt(2 * diffusion_mm2_s * (step + 0.5) * step_s));
        left -= dies;
      }
    }
    return sum / flashes;
  }
};

model::Resin resin_of(std::optional<double> lifetime_s, double dark_s = 0) {
  return {.diffusion_mm2_s = diffusion_mm2_s, .dose_lifetime_s = lifetime_s, .dark_s = dark_s};
}

}  // namespace

TEST_CASE("The dose's spread is that of flashes throughout the print and the dark after it, for any lifetime") {
  for (const double lifetime_s : {3.0, 60.0, 180.0, 2000.0, 1e12, std::numeric_limits<double>::infinity()}) {
    for (const double dark_s : {0.0, 30.0, 180.0}) {
      CAPTURE(lifetime_s);
      CAPTURE(dark_s);
      const Flashes slow{1 / lifetime_s, dark_s};
      const auto given = std::isinf(lifetime_s) ? std::nullopt : std::optional(lifetime_s);
      const double variance = slow.mean([](double sigma_mm) { return sigma_mm * sigma_mm; });
      CHECK(model::diffused_mm2(resin_of(given, dark_s), print_s) == doctest::Approx(variance).epsilon(3e-3));
    }
  }
  CHECK(model::diffused_mm2(resin_of(std::nullopt), print_s) == doctest::Approx(diffusion_mm2_s * print_s));
}

TEST_CASE("A lifetime far beyond the print counts like none, without a step") {
  const auto variance = [](double lifetime_s) { return model::diffused_mm2(resin_of(lifetime_s), print_s); };
  CHECK(variance(print_s / 0.999e-3) == doctest::Approx(variance(print_s / 1.001e-3)).epsilon(1e-6));
  CHECK(variance(1e15) == doctest::Approx(diffusion_mm2_s * print_s).epsilon(1e-12));
  CHECK(model::diffused_mm2(resin_of(3), 0) == 0);
}

TEST_CASE("point spread and diffusion add in variance") {
  model::Resin resin = resin_of(std::nullopt);
  resin.psf_mm = 0.03;
  CHECK(model::spread_mm(resin, 16) == doctest::Approx(0.05));
}
