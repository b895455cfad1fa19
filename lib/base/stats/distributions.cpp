// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/distributions.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>

namespace vam::stats {

namespace {

// In double on every machine, and nan of nan.
namespace policies = boost::math::policies;
using Plain = policies::policy<policies::promote_double<false>, policies::domain_error<policies::ignore_error>,
                               policies::overflow_error<policies::ignore_error>>;

// Regularised incomplete beta function I_x(a, b) [physics §14.5].
double beta(double x, double a, double b) { return boost::math::ibeta(a, b, std::clamp(x, 0.0, 1.0), Plain{}); }

}  // namespace

double student_tail(double t, double freedom) { return beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5); }

double student_quantile(double tail, double freedom) {
  double rest = 0;  // 1 - x
  const double x = boost::math::ibeta_inv(0.5 * freedom, 0.5, tail, &rest, Plain{});
  return std::sqrt(freedom * rest / x);
}

double f_tail(double f, double upper, double lower) {
  return beta(lower / (lower + upper * f), 0.5 * lower, 0.5 * upper);
}

}  // namespace vam::stats
