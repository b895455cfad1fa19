// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/tolerances.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::model;

TEST_CASE("tolerances are read with their units") {
  const Tolerances all = parse_tolerances("axis=0.5px, index=0.005,angle=0.25 deg,radius=0.2%,lamp=3 %,psf=0.05mm");
  CHECK(all == Tolerances{0.5, 0.005, 0.25, 0.2, 3, 0.05});
  CHECK(parse_tolerances("psf=0.1mm") == Tolerances{0, 0, 0, 0, 0, 0.1});
}

TEST_CASE("tolerances are written as they are read; a quantity without one is named") {
  const Tolerances some{0.5, 0, 0.25, 0.2, 0, 0.05};
  CHECK(tolerances_text(some) == "axis=0.5px,angle=0.25deg,radius=0.2%,psf=0.05mm");
  CHECK(parse_tolerances(tolerances_text(some)) == some);
  CHECK(exact_quantities(some) == std::vector<std::string>{"index", "lamp"});
}

TEST_CASE("wrong tolerances are reported") {
  CHECK_THROWS_WITH_AS(static_cast<void>(parse_tolerances("colour=3")), doctest::Contains("there are axis, index"),
                       Error);
  CHECK_THROWS_WITH_AS(static_cast<void>(parse_tolerances("axis")), doctest::Contains("'axis' has no '='"), Error);
  CHECK_THROWS_WITH_AS(static_cast<void>(parse_tolerances("")), doctest::Contains("no tolerance"), Error);
  CHECK_THROWS_WITH_AS(static_cast<void>(parse_tolerances("axis=1px,axis=2px")), doctest::Contains("twice"), Error);
  CHECK_THROWS_WITH_AS(static_cast<void>(parse_tolerances("axis=0.5")),
                       doctest::Contains("'axis=0.5': the unit must be px"), Error);
  for (const char* bad :
       {"axis=", "axis=-1px", "axis=0px", "axis=1mm", "lamp=nan%", "lamp=inf%", "psf=0.1", "axis=1px,"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(static_cast<void>(parse_tolerances(bad)), Error);
  }
}

TEST_CASE("a printer deviates only in quantities that have a tolerance") {
  const Printer printer;
  const DeviatingPrinter off = deviate(printer, {0.5, 0.005, 0.25, 0.2, 3, 0.05}, {1, -1, 1, -1, 1, -1});
  CHECK(off.printer.projector.axis_column == doctest::Approx(printer.projector.axis_column + 0.5));
  CHECK(off.printer.resin.index == doctest::Approx(printer.resin.index - 0.005));
  CHECK(off.angle_offset_rad == doctest::Approx(0.25 * std::acos(-1.0) / 180));
  CHECK(off.printer.vial.radius_mm == doctest::Approx(printer.vial.radius_mm * 0.998));
  CHECK(off.intensity == doctest::Approx(1.03));
  CHECK(off.printer.resin.psf_mm == 0);  // never below 0
  CHECK_THROWS_WITH_AS(static_cast<void>(deviate(printer, {0, 0, 0, 0, 150, 0}, {0, 0, 0, 0, -1, 0})),
                       doctest::Contains("impossible printer"), Error);
}

TEST_CASE("corners and their opposites hold every two quantities in all four ways") {
  const auto corners = balanced_corners();
  for (std::size_t a = 0; a < robust_kinds; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double product = 0;
      for (const PrinterDeviation& corner : corners) {
        CHECK(std::abs(corner[a]) == 1);
        product += corner[a] * corner[b];
      }
      CHECK(product == 0);
    }
  }
}

TEST_CASE("drawn printers are even within their tolerances and always the same") {
  constexpr int count = 4000;
  PrinterDeviation mean{}, square{};
  for (int n = 0; n < count; ++n) {
    const PrinterDeviation by = drawn_deviation(13, n);
    CHECK(by == drawn_deviation(13, n));
    for (std::size_t i = 0; i < by.size(); ++i) {
      CHECK(std::abs(by[i]) <= 1);
      mean[i] += by[i] / count;
      square[i] += by[i] * by[i] / count;
    }
  }
  for (std::size_t i = 0; i < mean.size(); ++i) {  // within four standard errors
    CHECK(std::abs(mean[i]) < 4 * std::sqrt(1.0 / 3 / count));
    CHECK(std::abs(square[i] - 1.0 / 3) < 4 * std::sqrt(4.0 / 45 / count));
  }
}
