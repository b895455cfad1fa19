// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/sweep.hpp"

#include <limits>

#include "lib/resin/corrected_column.hpp"
#include "resin/curethrough/gaps.hpp"
#include "testing.hpp"

using namespace vam;

TEST_CASE("a graded ladder") {
  CHECK(resin::graded_ladder({1, 2}) == std::vector<std::uint8_t>{0, 1, 0, 0, 1, 1, 0, 0});
}

TEST_CASE("the error is gone where the assumed full-cure dose is the real one, and grows away from it") {
  resin::Study study;
  study.process.speed_mm_h = 750;  // [CURE19]: h_a = 2000 um, 750 mm/h, D_f = 5 D_c = 748 mJ/cm3
  study.process.full_cure_dose_mj_cm3 = 748;
  study.gel_dose_mj_cm3 = 149.6;
  study.dose_factors = {1, 2, 3, 4, 5, 6, 7, 8};
  study.omega_max = {1, 2, 5, std::numeric_limits<double>::infinity()};
  const auto part = resin::graded_ladder({4, 6, 8, 10, 20, 40});
  const auto points = resin::run_study(part, study);
  REQUIRE(points.size() == 32);
  for (std::size_t m = 0; m < 4; ++m) {
    const auto at = [&](int factor) { return points[static_cast<std::size_t>(factor - 1) * 4 + m]; };
    REQUIRE(at(5).printable);
    REQUIRE(at(5).sizes.size() == 6);
    // The paper's figure is a reduction by more than 85 %; the model itself has nothing left but rounding.
    CHECK(at(5).ratio < 1e-3);
    for (const auto& size : at(5).sizes) CHECK(size.ratio() < 1e-3);
    CHECK(at(1).ratio > at(5).ratio);  // too little dose: missing features
    CHECK(at(8).ratio > at(6).ratio);  // too much: cure-through
    CHECK(at(6).ratio > at(5).ratio);
  }
}

TEST_CASE("a study needs values in range") {
  resin::Study study{.gel_dose_mj_cm3 = 100, .omega_max = {1}};
  CHECK_THROWS_WITH_AS((void)resin::run_study({0, 1, 0}, study), "df_over_dc: no values; give a list or a range",
                       Error);
  study.dose_factors = {0};
  CHECK_THROWS_AS((void)resin::run_study({0, 1, 0}, study), Error);
  study.dose_factors = {1};
  study.omega_max = {0.5};
  CHECK_THROWS_WITH_AS((void)resin::run_study({0, 1, 0}, study), "omega_max: 0.5 is out of range; give at least 1",
                       Error);
}

TEST_CASE("the least dose in a gap is the one that a correction reaches") {
  for (const auto exposure : {resin::ExposureMode::continuous, resin::ExposureMode::layered}) {
    resin::Process process{.exposure = exposure, .absorbance_height_um = 600};
    const resin::CureLimits limits = resin::limits_of(process);
    for (int gap = 2; gap < 60; gap += 3) {
      std::vector<std::uint8_t> part(static_cast<std::size_t>(gap + 20), 0);
      for (std::size_t n = 0; n < 10; ++n) part[n] = part[part.size() - 1 - n] = 1;
      const auto column = test::correct_column(part, limits, {1}, 8);
      REQUIRE(test::violation(part, column.phi, limits, 1) == "");
      double least = 1;
      for (std::size_t n = 0; n < part.size(); ++n) least = std::min(least, column.omega[n]);
      CHECK(resin::lowest_gap_dose(limits, gap) == doctest::Approx(least).epsilon(1e-9));
    }
    const int narrowest = resin::narrowest_gap(limits, 0.5);
    CHECK(resin::lowest_gap_dose(limits, narrowest) <= 0.5);
    CHECK(resin::lowest_gap_dose(limits, narrowest - 1) > 0.5);
  }
}

TEST_CASE("gaps of a part: those that fuse, those at the limit and those that are open") {
  // Columns side by side with a gap of 1, 3, 40 slices, two gaps (1 and 3), no gap, nothing.
  const std::vector<std::vector<int>> gaps{{1}, {3}, {40}, {1, 3}, {}, {}};
  const int width = static_cast<int>(gaps.size());
  const int slices = 70;
  resin::PartColumns part(width, 1, slices, resin::ExposureMode::continuous);
  for (int x = 0; x + 1 < width; ++x) {
    int n = 4;
    const auto put = [&](int count) {
      part.fill(static_cast<std::size_t>(x), n, count, true);
      n += count;
    };
    put(5);
    for (const int gap : gaps[x]) {
      n += gap;
      put(5);
    }
  }
  const resin::CureLimits limits = resin::limits_of({});
  const resin::GapReport report = resin::judge_gaps(part, limits, 0.5);
  CHECK(report.mask.values == std::vector<float>{2, 1, 0, 2, 0, 0});
  CHECK(report.infeasible_columns == 2);
  CHECK(report.infeasible_gaps == 2);
  CHECK(report.tight_columns == 3);
  CHECK(report.tight_gaps == 4);
  CHECK(report.narrowest == 1);
  CHECK(report.worst_dose == 1);
}

TEST_CASE("faster means wider gaps, up to the speed limit") {
  resin::Process process;
  CHECK(resin::speed_limit_mm_h(process) == doctest::Approx(110 / 576.0 * 36000));  // I_max / D_f, cm/s to mm/h
  int before = 0;
  for (const double fraction : {0.1, 0.4, 0.7, 0.95}) {
    process.speed_mm_h = fraction * resin::speed_limit_mm_h(process);
    const int gap = resin::narrowest_gap(resin::limits_of(process), 0.5);
    CHECK(gap > before);
    before = gap;
  }
  process.speed_mm_h = 1.01 * resin::speed_limit_mm_h(process);
  CHECK(resin::narrowest_gap(resin::limits_of(process), 0.5) == 0);
}

TEST_CASE("a full-cure dose is printable between the least and the largest intensity") {
  resin::Study study;
  study.process.speed_mm_h = 3600;  // 0.1 cm/s: the intensity is a tenth of the dose
  study.process.min_intensity_mw_cm2 = 5;
  study.process.max_intensity_mw_cm2 = 110;
  study.process.full_cure_dose_mj_cm3 = 100;
  study.gel_dose_mj_cm3 = 100;
  study.dose_factors = {0.49, 0.51, 10.9, 11.1};
  study.omega_max = {1};
  const auto points = resin::run_study({0, 1, 0}, study);
  REQUIRE(points.size() == 4);
  CHECK_FALSE(points[0].printable);  // dark pixels cure, too
  CHECK(points[1].printable);
  CHECK(points[2].printable);
  CHECK_FALSE(points[3].printable);  // full light never does
}
