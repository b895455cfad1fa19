// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/student.hpp"

#include <cmath>

namespace vam::stats {

namespace {

// Continued fraction of the incomplete beta function, by Lentz's method [AS64 formula 26.5.8; physics §14.5].
double beta_fraction(double x, double a, double b) {
  constexpr double tiny = 1e-300;
  const auto kept = [](double value) { return std::fabs(value) < tiny ? tiny : value; };
  double c = 1;
  double d = 1 / kept(1 - (a + b) * x / (a + 1));
  double result = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / kept(1 + even * d);
    c = kept(1 + even / c);
    result *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / kept(1 + odd * d);
    c = kept(1 + odd / c);
    result *= d * c;
    if (std::fabs(d * c - 1) < 1e-15) break;
  }
  return result;
}

// Regularised incomplete beta function I_x(a, b).
double beta(double x, double a, double b) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(x, a, b) / a;
  return 1 - front * beta_fraction(1 - x, b, a) / b;  // where the fraction converges fast
}

}  // namespace

double student_tail(double t, double freedom) { return beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5); }

double student_quantile(double tail, double freedom) {
  double low = 0;
  double high = 1;
  while (student_tail(high, freedom) > tail && high < 1e12) high *= 2;
  for (int step = 0; step < 200 && high - low > 1e-13 * high; ++step) {
    const double middle = 0.5 * (low + high);
    (student_tail(middle, freedom) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double f_tail(double f, double upper, double lower) {
  return beta(lower / (lower + upper * f), 0.5 * lower, 0.5 * upper);
}

}  // namespace vam::stats
