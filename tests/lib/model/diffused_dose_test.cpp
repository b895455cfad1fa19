// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusion during a print, against the mean over the times at which the light arrives.
#include "oracle/diffused_dose.hpp"

#include "model/dose/dose_spread.hpp"
#include "testing.hpp"

namespace {
constexpr vam::oracle::SlitPrint slit{.slit_mm = 0.5, .diffusion_mm2_s = 1e-4, .seconds = 180};

double spread_mm(double diffusion_mm2_s, double seconds) {
  return vam::model::spread_mm(vam::model::Resin{.diffusion_mm2_s = diffusion_mm2_s}, seconds);
}

}  // namespace

TEST_CASE("light that arrives evenly over the print is spread by the variance of the Gaussian that stands for it") {
  double dose = 0;
  double second = 0;
  constexpr double step_mm = 0.01;
  for (double x_mm = -2; x_mm <= 2; x_mm += step_mm) {
    dose += vam::oracle::diffused_dose(slit, x_mm) * step_mm;
    second += vam::oracle::diffused_dose(slit, x_mm) * step_mm * x_mm * x_mm;
  }
  const double light_mm2 = slit.slit_mm * slit.slit_mm / 12;
  CHECK(dose == doctest::Approx(slit.slit_mm).epsilon(1e-4));
  const double spread = spread_mm(slit.diffusion_mm2_s, slit.seconds);
  // The sum of steps of 0.01 mm is exact to 1e-3: at the slit's sides the dose has a bend.
  CHECK(second / dose - light_mm2 == doctest::Approx(spread * spread).epsilon(1e-3));
}

// The mean over ages a of erf(q sqrt(T / a)) is erf q + 2 q exp(-q^2) / sqrt(pi) - 2 q^2 erfc q.
TEST_CASE("the oracle's dose in the middle of a slit is its closed form") {
  const double q = slit.slit_mm / 2 / std::sqrt(4 * slit.diffusion_mm2_s * slit.seconds);
  const double middle = std::erf(q) + 2 * q * std::exp(-q * q) / std::sqrt(std::numbers::pi) - 2 * q * q * std::erfc(q);
  CHECK(middle == doctest::Approx(0.928).epsilon(1e-4));
  CHECK(vam::oracle::diffused_dose(slit, 0) == doctest::Approx(middle).epsilon(1e-6));
}

// Light that arrives late has spread little: one Gaussian of the same variance leaves 0.9376 where 0.9279 is right.
TEST_CASE("the middle of a slit of 0.5 mm keeps what the mean over arrival times leaves, within 0.01") {
  const double spread = spread_mm(slit.diffusion_mm2_s, slit.seconds);
  const double kept = std::erf(slit.slit_mm / 2 / (spread * std::numbers::sqrt2));
  CHECK(std::abs(kept - vam::oracle::diffused_dose(slit, 0)) < 0.01);
}
