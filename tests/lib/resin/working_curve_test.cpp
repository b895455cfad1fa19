// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/working_curve.hpp"

#include "base/stats/distributions.hpp"
#include "testing.hpp"

using namespace vam;
using resin::CuredSample;

namespace {

// h_a = 2000 um and D_c = 748 / 5 mJ/cm3 [CURE19]: E_c = D_c h_a / ln(10) = 12.99 mJ/cm2.
constexpr double absorbance_um = 2000;
const double critical = 149.6 * 0.2 / std::log(10.0);

std::vector<CuredSample> measured(unsigned seed, double noise_um, int repeats = 3) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise_um);
  std::vector<CuredSample> samples;
  for (const double exposure : {20.0, 30.0, 50.0, 80.0, 130.0, 200.0}) {
    for (int r = 0; r < repeats; ++r) {
      samples.push_back(
          {exposure, absorbance_um * std::log10(exposure / critical) + (noise_um > 0 ? normal(random) : 0)});
    }
  }
  return samples;
}

// P(|T| > t) by the trapezoidal rule over the density, substituted so that the tail is finite: T = tan(angle).
double integrated_tail(double t, double freedom) {
  const auto density = [&](double x) { return std::pow(1 + x * x / freedom, -0.5 * (freedom + 1)); };
  const auto area = [&](double from, double to) {
    const int steps = 200000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double angle = from + (to - from) * (i + 0.5) / steps;
      const double cosine = std::cos(angle);
      sum += density(std::tan(angle)) / (cosine * cosine) * (to - from) / steps;
    }
    return sum;
  };
  const double right = std::acos(-1.0) / 2;
  return area(std::atan(t), right) / area(0, right);
}

std::string message(const std::vector<CuredSample>& samples) {
  return error_of([&] { (void)resin::fit_working_curve(samples); }, Fault::data);
}

}  // namespace

TEST_CASE("Student's t") {
  for (const double freedom : {1.0, 2.0, 5.0, 16.0, 120.0}) {
    for (const double t : {0.1, 1.0, 2.5, 6.0}) {
      CHECK(stats::student_tail(t, freedom) == doctest::Approx(integrated_tail(t, freedom)).epsilon(1e-6));
    }
  }
  CHECK(stats::student_quantile(0.05, 5) == doctest::Approx(2.570582).epsilon(1e-6));  // any printed table
  CHECK(stats::student_quantile(0.01, 10) == doctest::Approx(3.169273).epsilon(1e-6));
  CHECK(stats::student_tail(stats::student_quantile(0.02, 7), 7) == doctest::Approx(0.02).epsilon(1e-9));
  CHECK(stats::f_tail(4.102821, 2, 10) == doctest::Approx(0.05).epsilon(1e-5));
  CHECK(stats::f_tail(3.0 * 3.0, 1, 8) == doctest::Approx(stats::student_tail(3.0, 8)).epsilon(1e-9));
}

TEST_CASE("exact data give the exact curve") {
  const auto curve = resin::fit_working_curve(measured(0, 0));
  CHECK(curve.absorbance_height_um == doctest::Approx(2000).epsilon(1e-10));
  CHECK(curve.critical_exposure_mj_cm2 == doctest::Approx(critical).epsilon(1e-10));
  CHECK(curve.gel_dose_mj_cm3 == doctest::Approx(149.6).epsilon(1e-10));
  CHECK(curve.penetration_depth_um == doctest::Approx(868.589).epsilon(1e-6));
  CHECK(curve.exposures == 6);
  CHECK(curve.samples == 18);
}

TEST_CASE("R squared is the square of the correlation") {
  // About a line of 100 um a decade, 10 um up and down: of the squares 4 x 100^2 and 6 x 10^2.
  const std::vector<CuredSample> repeated{{10, 90}, {10, 110}, {100, 190}, {100, 210}, {1000, 290}, {1000, 310}};
  CHECK(resin::fit_working_curve(repeated).r_squared == doctest::Approx(40000.0 / 40600.0));
  CHECK(resin::fit_working_curve(measured(0, 0)).r_squared == doctest::Approx(1));
}

TEST_CASE("confidence intervals cover the true value at their stated rate") {
  int slope = 0;
  int exposure = 0;
  int dose = 0;
  int flagged = 0;
  const int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    const auto curve = resin::fit_working_curve(measured(static_cast<unsigned>(trial + 1), 80));
    const auto in = [](const resin::Interval& range, double value) {
      return range.low <= value && value <= range.high;
    };
    slope += in(curve.absorbance_height_range_um, absorbance_um);
    exposure += in(curve.critical_exposure_range_mj_cm2, critical);
    dose += in(curve.gel_dose_range_mj_cm3, 149.6);
    for (const bool outlier : curve.outlier) flagged += outlier;
  }
  // 95 % of 2000 has a standard deviation of 0.49 %: four of them. The delta method adds less.
  CHECK(std::fabs(slope / 2000.0 - 0.95) < 0.02);
  CHECK(std::fabs(exposure / 2000.0 - 0.95) < 0.02);
  CHECK(std::fabs(dose / 2000.0 - 0.95) < 0.02);
  CHECK(std::fabs(flagged / 2000.0 - 0.05) < 0.02);  // Bonferroni: 5 % of clean data sets lose their innocence
}

TEST_CASE("an outlier is flagged and kept") {
  auto samples = measured(3, 20);
  samples[7].thickness_um += 400;
  const auto curve = resin::fit_working_curve(samples);
  for (std::size_t i = 0; i < samples.size(); ++i) CHECK(curve.outlier[i] == (i == 7));
  CHECK(curve.samples == 18);
  CHECK(curve.residual_um[7] > 300);
}

TEST_CASE("repeated readings separate scatter from curvature") {
  CHECK(resin::fit_working_curve(measured(11, 50)).lack_of_fit_p > 0.01);
  auto bent = measured(11, 20);
  for (auto& sample : bent) sample.thickness_um += 400 * std::pow(std::log10(sample.exposure_mj_cm2 / 60), 2);
  CHECK(resin::fit_working_curve(bent).lack_of_fit_p < 1e-3);
  CHECK(resin::fit_working_curve(measured(11, 50, 1)).lack_of_fit_p == 1);
}

TEST_CASE("data that determine no working curve are errors") {
  CHECK(message({{10, 100}, {10, 110}, {20, 300}, {20, 310}}) ==
        "working curve: 2 different exposures are too few for a line fit; measure at least 3");
  CHECK(has(message({{10, 100}, {20, 0}, {30, 300}}), "sample 2 has exposure 20 mJ/cm2 and thickness 0 um"));
  CHECK(has(message({{10, 300}, {20, 200}, {30, 100}}), "falls as the exposure rises"));
  CHECK(has(message({{10, 300}, {20, 100}, {30, 350}}), "beyond its scatter"));
}
