// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/response_fit.hpp"

#include <limits>

#include "resin/response.hpp"
#include "testing.hpp"

using namespace vam;
using resin::PhotodiodeReading;

namespace {

std::vector<PhotodiodeReading> power_law(double noise, int repeats, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<PhotodiodeReading> readings;
  for (int r = 0; r < repeats; ++r) {
    for (int grey = 0; grey <= 255; grey += 15) {
      const double light = 2 + 800 * std::pow(grey / 255.0, 2.2);
      readings.push_back({static_cast<double>(grey), 5 + light + noise * normal(random)});
    }
  }
  return readings;
}

}  // namespace

TEST_CASE("clean readings come back as the table") {
  const auto fit = resin::fit_response(power_law(0, 2, 1), 5, "diode.csv");
  REQUIRE(fit.table.grey.size() == 18);
  CHECK(fit.table.intensity.front() == doctest::Approx(2));
  CHECK(fit.table.intensity.back() == doctest::Approx(802));
  CHECK(fit.contrast == doctest::Approx(401));
  CHECK(fit.gamma == doctest::Approx(2.2).epsilon(1e-6));
  CHECK(fit.pooled == 0);
  const resin::Response response(fit.table);
  CHECK(response.intensity(1) == doctest::Approx(1));
  CHECK(response.grey(response.intensity(0.43)) == doctest::Approx(0.43).epsilon(1e-6));
}

TEST_CASE("noise near the dark is pooled, and the curve still rises") {
  const auto fit = resin::fit_response(power_law(3, 4, 7), 5, "diode.csv");
  CHECK(fit.noise == doctest::Approx(3).epsilon(0.3));
  for (std::size_t i = 1; i < fit.table.intensity.size(); ++i) {
    CHECK(fit.table.intensity[i] >= fit.table.intensity[i - 1]);
  }
  CHECK_NOTHROW(resin::Response(fit.table));
}

TEST_CASE("pooling is the isotonic least squares solution") {
  // Means 0, 4, 3, 5 with a noise that excuses the fall of 1: levels 1 and 2 both become 3.5.
  const std::vector<PhotodiodeReading> readings{{0, -2}, {0, 2}, {1, 3}, {1, 5}, {2, 1}, {2, 5}, {3, 4}, {3, 6}};
  const auto fit = resin::fit_response(readings, 0, "d");
  CHECK(fit.table.intensity == std::vector<double>{0, 3.5, 3.5, 5});
  CHECK(fit.pooled == 2);
  CHECK(fit.contrast == std::numeric_limits<double>::infinity());
}

TEST_CASE("readings that determine no response are errors") {
  const auto message = [](const std::vector<PhotodiodeReading>& readings, double dark) {
    return error_of([&] { (void)resin::fit_response(readings, dark, "d.csv"); }, Fault::data);
  };
  CHECK(
      message({{0, 1}, {100, 50}, {200, 40}, {255, 90}}, 0) ==
      "d.csv: the reading falls from 50 at grey 100 to 40 at grey 200, beyond the noise; a response must rise, measure "
      "again");
  CHECK(message({{0, 1}, {255, 50}}, 0) == "d.csv: 2 grey levels do not make a curve; measure at least 3");
  CHECK(has(message({{1, 1}, {100, 20}, {255, 50}}, 0), "the lowest grey is 1"));
  CHECK(has(message({{0, 1}, {100, 2}, {255, 3}}, 10), "zero intensity"));
}

TEST_CASE("a fall of three standard errors of the difference is noise, and no more") {
  // Readings 1 above and 1 below their mean: 2, 8 and 2 of them have a pooled variance of 12 / 9, and the difference of
  // neighbouring means has that times 1 / 8 + 1 / 2.
  const double error = std::sqrt(12.0 / 9 * (1.0 / 8 + 1.0 / 2));
  const auto accepted = [](double first, double second, bool long_first) {
    std::vector<PhotodiodeReading> readings{{0, -1}, {0, 1}};
    for (int i = 0; i < (long_first ? 4 : 1); ++i) {
      readings.push_back({1, first - 1});
      readings.push_back({1, first + 1});
    }
    for (int i = 0; i < (long_first ? 1 : 4); ++i) {
      readings.push_back({2, second - 1});
      readings.push_back({2, second + 1});
    }
    return !fault_of([&] { (void)resin::fit_response(readings, 0, "d"); });
  };
  for (const bool long_first : {false, true}) {
    CHECK(accepted(20, 20 - 2.99 * error, long_first));
    CHECK_FALSE(accepted(20, 20 - 3.01 * error, long_first));
  }
}
