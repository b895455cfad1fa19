// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/column_dose.hpp"

#include "oracle/beer_law.hpp"
#include "testing.hpp"

using namespace vam;
using resin::ExposureMode;

namespace {

std::vector<double> random_intensities(int count, double low, double high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) value = uniform(random);
  return values;
}

// Omega at every node by the oracle, against the recursion. The midpoint rule errs by (eta ln 10 / steps)^2 / 24 of the
// dose: below 1e-9 for the thickest slice here with 2000 steps; 1e-6 is required.
void compare(const resin::Process& process, std::uint32_t seed) {
  const resin::CureLimits limits = resin::limits_of(process);
  const double critical = resin::full_cure_intensity_mw_cm2(process);
  const int slices = 30;
  vam::oracle::Print print{process.slice_um * 1e-3, process.absorbance_height_um * 1e-3, process.speed_mm_h / 3600, {}};
  print.intensity_mw_cm2 = random_intensities(slices, process.min_intensity_mw_cm2, process.max_intensity_mw_cm2, seed);
  std::vector<double> phi;
  for (const double value : print.intensity_mw_cm2) phi.push_back(value / critical);
  const std::vector<double> omega = resin::dose_at_nodes(phi, limits);
  REQUIRE(omega.size() == slices + 1);
  CHECK(omega.back() == 0);
  for (int n = 0; n < slices; ++n) {
    const double z = n * print.slice_mm;
    const double dose = process.exposure == ExposureMode::continuous ? vam::oracle::continuous_dose_mj_cm3(print, z)
                                                                     : vam::oracle::layered_dose_mj_cm3(print, z);
    const double expected = dose / process.full_cure_dose_mj_cm3;
    CHECK(std::fabs(omega[n] - expected) <= 1e-6 * expected);
  }
}

}  // namespace

TEST_CASE("the recursion is Beer's law integrated over time") {
  for (const auto exposure : {ExposureMode::continuous, ExposureMode::layered}) {
    for (const double absorbance_um : {150.0, 500.0, 2000.0}) {
      resin::Process process{
          .exposure = exposure, .absorbance_height_um = absorbance_um, .full_cure_dose_mj_cm3 = 173, .speed_mm_h = 800};
      compare(process, static_cast<std::uint32_t>(absorbance_um));
    }
  }
}

TEST_CASE("the dose half way through a slice and the cured thickness agree with Beer's law") {
  resin::Process process{.absorbance_height_um = 300};
  const resin::CureLimits limits = resin::limits_of(process);
  const double critical = resin::full_cure_intensity_mw_cm2(process);
  vam::oracle::Print print{0.05, 0.3, 1000.0 / 3600, random_intensities(12, 1, 110, 5), 2000};
  std::vector<double> phi;
  for (const double value : print.intensity_mw_cm2) phi.push_back(value / critical);
  const std::vector<double> omega = resin::dose_at_nodes(phi, limits);
  for (int n = 0; n < 12; ++n) {
    const auto i = static_cast<std::size_t>(n);
    const double centre = vam::oracle::continuous_dose_mj_cm3(print, (n + 0.5) * 0.05) / 576;
    CHECK(resin::dose_at_centre(phi[i], omega[i + 1], limits) == doctest::Approx(centre).epsilon(1e-6));
    // A threshold between the doses of both planes is crossed at the fraction: the oracle's dose there equals it.
    const double threshold = 0.3 * omega[i] + 0.7 * omega[i + 1];
    const double fraction = resin::cured_fraction(phi[i], omega[i + 1], threshold, limits);
    const double depth = omega[i] > omega[i + 1] ? fraction : 1 - fraction;  // from the platform side
    // The oracle starts the exposure of a point inside a slice at one of its 2000 steps: half a step of 110/16.
    const double there = vam::oracle::continuous_dose_mj_cm3(print, (n + depth) * 0.05) / 576;
    CHECK(std::fabs(there - threshold) < 0.5 / 2000 * (1 - limits.q) * 110 / critical * 1.5);
  }
}

TEST_CASE("cured fraction of a layer") {
  const resin::CureLimits limits = resin::limits_of(resin::Process{.exposure = ExposureMode::layered});
  CHECK(resin::cured_fraction(2, 0, 1, limits) == 1);
  CHECK(resin::cured_fraction(0.5, 0.1, 1, limits) == 0);
  // Dose 1.02 at the window side falls to 1 after h_a log10(1.02) = 17.2 um = 0.344 slices.
  CHECK(resin::cured_fraction(1.0, 0.02, 1, limits) == doctest::Approx(2000 * std::log10(1.02) / 50).epsilon(1e-9));
}

TEST_CASE("the worked example of the paper") {
  const resin::Process process;
  CHECK(resin::full_cure_intensity_mw_cm2(process) == doctest::Approx(16.0));  // [physics §9]
  const resin::CureLimits limits = resin::limits_of(process);
  CHECK(limits.q == doctest::Approx(std::pow(10, -0.025)));
  CHECK(limits.hold() == 1);
  CHECK(resin::burst_slices(limits) == 3);  // [CURE19 fig 4]: slices 51..53 beyond the 50
}

TEST_CASE("a burst is the fewest slices that reach the full-cure dose") {
  for (const double phi_max : {1.001, 1.1, 2.0, 6.3, 17.0, 100.0}) {
    resin::CureLimits limits = resin::limits_of({});
    limits.phi_max = phi_max;
    const int count = resin::burst_slices(limits);
    const auto reached = [&](int slices) {
      return resin::dose_at_nodes(std::vector<double>(static_cast<std::size_t>(slices), phi_max), limits)[0];
    };
    CHECK(reached(count) >= 1 - 1e-9);
    CHECK(reached(count - 1) < 1);
  }
  resin::CureLimits weak = resin::limits_of({});
  weak.phi_max = 1;
  CHECK(resin::burst_slices(weak) == 0);
}

TEST_CASE("impossible processes are refused with their numbers") {
  const auto message = [](const resin::Process& process) {
    return error_of([&] { (void)resin::limits_of(process); }, Fault::data);
  };
  resin::Process process{.min_intensity_mw_cm2 = 110};
  CHECK(message(process) ==
        "intensity range: the minimum, 110 mW/cm2, must be at least 0 and below the maximum, 110 mW/cm2");
  process = {};
  process.slice_um = 1001;
  process.absorbance_height_um = 100;
  CHECK(has(message(process), "more than ten absorbance heights"));
  process.slice_um = 1000;
  CHECK(message(process) == "no error");
  process = {};
  process.speed_mm_h = 0;
  CHECK(message(process) == "print speed: 0 mm/h is not a positive number");
  process = {};
  process.absorbance_height_um = std::nan("");
  CHECK(message(process).find("absorbance height") == 0);
}

TEST_CASE("within a slice: the dose half way, and where it crosses the threshold, by Beer's law") {
  resin::Process process{.slice_um = 400, .absorbance_height_um = 1000};
  const double q = std::pow(10, -0.4);
  resin::CureLimits limits = resin::limits_of(process);
  CHECK(limits.q == doctest::Approx(q).epsilon(1e-14));
  CHECK(limits.gain == doctest::Approx(1 - q).epsilon(1e-14));
  CHECK(limits.settled(1.7) == doctest::Approx(1.7).epsilon(1e-14));
  CHECK(resin::full_cure_intensity_mw_cm2(process) == doctest::Approx(100.0 / 3600 * 576).epsilon(1e-14));
  // Towards the far side the dose tends from that of the node to the light's: 2 + (0.3 - 2) q^u.
  CHECK(resin::dose_at_centre(2, 0.3, limits) == doctest::Approx(2 - 1.7 * std::pow(q, 0.5)).epsilon(1e-14));
  const double crossing = std::log((0.8 - 2) / (0.3 - 2)) / std::log(q);
  CHECK(resin::cured_fraction(2, 0.3, 0.8, limits) == doctest::Approx(1 - crossing).epsilon(1e-12));
  CHECK(resin::cured_fraction(0, 1.6, 0.8, limits) == doctest::Approx(std::log(0.5) / std::log(q)).epsilon(1e-12));
  CHECK(resin::cured_fraction(2, 0.8, 0.8, limits) == 1);
  CHECK(resin::cured_fraction(0, 0.8, 0.8, limits) == 0);

  process.exposure = ExposureMode::layered;
  limits = resin::limits_of(process);
  CHECK(limits.gain == doctest::Approx(q).epsilon(1e-14));
  CHECK(resin::full_cure_intensity_mw_cm2(process) ==
        doctest::Approx(100.0 / 3600 * 576 / (std::log(10.0) * 0.4)).epsilon(1e-14));
  CHECK(resin::dose_at_centre(2, 0.3, limits) == doctest::Approx(2.3 * std::pow(q, 0.5)).epsilon(1e-14));
  CHECK(resin::cured_fraction(1.3, 0.3, 0.8, limits) == doctest::Approx(std::log(0.5) / std::log(q)).epsilon(1e-12));
}
