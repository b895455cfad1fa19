// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/curve_fit.hpp"
#include "base/stats/distributions.hpp"
#include "base/stats/measured.hpp"
#include "base/stats/median.hpp"
#include "base/stats/range.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::stats;

TEST_CASE("Student's t as in the tables, and in closed form for one and two degrees of freedom") {
  CHECK(student_quantile(0.05, 4) == doctest::Approx(2.776445).epsilon(1e-6));
  CHECK(student_quantile(0.05, 10) == doctest::Approx(2.228139).epsilon(1e-6));
  CHECK(student_quantile(0.01, 30) == doctest::Approx(2.749996).epsilon(1e-6));
  for (const double t : {0.1, 0.9, 1.0, 3.0, 40.0}) {
    CHECK(student_tail(t, 1) == doctest::Approx(1 - 2 / std::acos(-1.0) * std::atan(t)).epsilon(1e-10));
    CHECK(student_tail(-t, 2) == doctest::Approx(1 - t / std::sqrt(2 + t * t)).epsilon(1e-10));
    CHECK(f_tail(t * t, 1, 7) == doctest::Approx(student_tail(t, 7)).epsilon(1e-10));  // F of 1 and n is t^2
    CHECK(f_tail(t, 2, 6) == doctest::Approx(std::pow(1 + t / 3, -3)).epsilon(1e-10));
  }
  CHECK(few_readings_factor(4) == doctest::Approx(2.776445 / 1.959964).epsilon(1e-6));
  CHECK(few_readings_factor(0) == doctest::Approx(12.706205 / 1.959964).epsilon(1e-6));  // as of one degree
  CHECK(few_parts_factor({2, 2, 2, 2}) == doctest::Approx(few_readings_factor(4)));
  CHECK(few_parts_factor({1e3, 1e-3, 1e-3, 1e-3}) == doctest::Approx(few_readings_factor(1)));  // one of them counts
  CHECK(few_parts_factor({}) == 1);
}

TEST_CASE("a weighted mean, of parts that agree and of parts that do not") {
  const Measured agree = weighted_mean({{10, 1, 3}, {10.5, 2, 4}});
  CHECK(agree.value == doctest::Approx((10 + 10.5 / 4) / 1.25));
  CHECK(agree.sigma == doctest::Approx(std::sqrt(1 / 1.25)));
  CHECK(agree.n == 7);
  const Measured apart = weighted_mean({{0, 1, 1}, {10, 1, 1}, {5, 1, 1}});  // chi^2 = 50 of 2
  CHECK(apart.value == doctest::Approx(5));
  CHECK(apart.sigma == doctest::Approx(std::sqrt(25.0 / 3)));
  CHECK(weighted_mean({{4, 0.5, 9}}).sigma == doctest::Approx(0.5));
}

TEST_CASE("a weighted line through two points is exact, and scatter widens it") {
  const WeightedLine two = weighted_line({1, 3}, {{5, 0.1, 2}, {9, 0.2, 3}});
  CHECK(two.at_zero.value == doctest::Approx(3));
  CHECK(two.slope.value == doctest::Approx(2));
  CHECK(two.slope.sigma == doctest::Approx(std::hypot(0.1, 0.2) / 2));
  CHECK(two.at_zero.sigma == doctest::Approx(std::hypot(1.5 * 0.1, 0.5 * 0.2)));
  CHECK(two.slope.n == 5);
  // y = x^2 about x = 0: the line 2/3 + 0 x, residuals 1/3, -2/3, 1/3; chi^2 = 6/9 / 0.01 of one degree.
  const WeightedLine bent = weighted_line({-1, 0, 1}, {{1, 0.1, 1}, {0, 0.1, 1}, {1, 0.1, 1}});
  CHECK(bent.at_zero.value == doctest::Approx(2.0 / 3));
  CHECK(std::abs(bent.slope.value) < 1e-12);
  CHECK(bent.at_zero.sigma == doctest::Approx(std::sqrt(2.0 / 3 / 3)));
  CHECK(bent.slope.sigma == doctest::Approx(std::sqrt(2.0 / 3 / 2)));
  const Measured lean = lean_deg({0.5, 0.1, 6}, 2);
  CHECK(lean.value == doctest::Approx(45));
  CHECK(lean.sigma == doctest::Approx(0.2 / 2 * 180 / std::acos(-1.0)));
}

TEST_CASE("a fitted line has the covariance HC3 by hand, whatever the origin of x") {
  constexpr std::array<double, 5> y{1, 2.5, 2, 4.4, 5.1};  // at x = -2 ... 2: sums of x and x^3 are 0, of x^2 is 10
  double middle = 0, slope = 0;
  for (int i = 0; i < 5; ++i) {
    middle += y[i] / 5;
    slope += y[i] * (i - 2) / 10;
  }
  double c00 = 0, c01 = 0, c11 = 0, squares = 0;
  for (int i = 0; i < 5; ++i) {
    const double x = i - 2;
    const double residual = y[i] - middle - slope * x;
    const double leverage = 0.2 + x * x / 10;
    const double weight = std::pow(residual / (1 - leverage), 2);
    squares += residual * residual;
    c00 += weight / 25;
    c01 += weight * x / 50;
    c11 += weight * x * x / 100;
  }
  const double wider = std::pow(student_quantile(0.05, 3) / 1.959964, 2);
  constexpr double origin = 3;  // the line is p0 + p1 (x + 3)
  const auto residuals = [&](const std::vector<double>& p) {
    std::vector<double> all;
    for (int i = 0; i < 5; ++i) all.push_back(y[i] - p[0] - p[1] * (i - 2 + origin));
    return all;
  };
  const CurveFit fit = fit_curve(residuals, {0, 0}, {1e-3, 1e-3}, "line");
  CHECK(fit.n == 5);
  CHECK(fit.rms == doctest::Approx(std::sqrt(squares / 5)));
  CHECK(fit.value[0] == doctest::Approx(middle - origin * slope));
  CHECK(fit.value[1] == doctest::Approx(slope));
  CHECK(fit.covariance[0] == doctest::Approx(wider * (c00 - 2 * origin * c01 + origin * origin * c11)).epsilon(1e-6));
  CHECK(fit.covariance[1] == doctest::Approx(wider * (c01 - origin * c11)).epsilon(1e-6));
  CHECK(fit.covariance[2] == doctest::Approx(fit.covariance[1]).epsilon(1e-9));
  CHECK(fit.covariance[3] == doctest::Approx(wider * c11).epsilon(1e-6));
  CHECK(fit.measured(1).sigma == doctest::Approx(std::sqrt(wider * c11)).epsilon(1e-6));
  const Measured at_middle = fit.combined({1, origin});  // at x = 0
  CHECK(at_middle.value == doctest::Approx(middle));
  CHECK(at_middle.sigma == doctest::Approx(std::sqrt(wider * c00)).epsilon(1e-6));
}

TEST_CASE("too few readings, or readings that do not determine the parameters, are refused") {
  const auto two = [](const std::vector<double>& p) { return std::vector<double>{1 - p[0], 2 - p[1]}; };
  CHECK(fault_of([&] { static_cast<void>(fit_curve(two, {0, 0}, {1e-3, 1e-3}, "few")); }) == Fault::data);
  const auto same = [](const std::vector<double>& p) {
    return std::vector<double>{1 - p[0] - p[1], 2 - p[0] - p[1], 4 - p[0] - p[1]};
  };
  CHECK(fault_of([&] { static_cast<void>(fit_curve(same, {0, 0}, {1e-3, 1e-3}, "same")); }) == Fault::data);
}

TEST_CASE("a linear fit gives the parts of its columns, equal columns a half each") {
  // Columns 1 and x at x = 0, 1, 2, 5; values 2 - 3 x.
  const std::vector<double> parts = linear_fit({1, 0, 1, 1, 1, 2, 1, 5}, 2, {2, -1, -4, -13});
  CHECK(parts[0] == doctest::Approx(2).epsilon(1e-6));
  CHECK(parts[1] == doctest::Approx(-3).epsilon(1e-6));
  const std::vector<double> halves = linear_fit({1, 1, 2, 2}, 2, {6, 12});
  CHECK(halves[0] == doctest::Approx(3).epsilon(1e-4));
  CHECK(halves[1] == doctest::Approx(3).epsilon(1e-4));
}

TEST_CASE("the median is the upper of the middle two, the normal integral is that of the tables") {
  CHECK(median(std::vector<int>{5, 1, 3}) == 3);
  CHECK(median(std::vector<int>{4, 1, 3, 2}) == 3);
  CHECK(normal_integral(0) == doctest::Approx(0.5));
  CHECK(normal_integral(1.959964) == doctest::Approx(0.975).epsilon(1e-7));
  CHECK(normal_integral(-1) == doctest::Approx(0.158655254).epsilon(1e-8));
}

TEST_CASE("the least and the largest of any number of values") {
  std::mt19937 draw(3);  // NOLINT(cert-msc51-cpp): the same values every time
  std::uniform_real_distribution<float> value(-5, 5);
  for (const std::size_t count : {1, 2, 15, 16, 17, 100}) {
    for (int trial = 0; trial < 50; ++trial) {
      std::vector<float> values(count);
      for (float& v : values) v = value(draw);
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      CHECK(range_of(values) == std::pair{*low, *high});
    }
  }
}
