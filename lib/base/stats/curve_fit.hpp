// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares for measurements: the parameters of a curve, and how well they are known.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/stats/measured.hpp"

namespace vam::stats {

struct CurveFit {
  std::vector<double> value;
  std::vector<double> covariance;  // row-major, size of value squared
  double rms = 0;                  // of the residuals
  int n = 0;                       // of residuals
  /// Parameter i with its sigma.
  [[nodiscard]] Measured measured(std::size_t i) const;
  /// sum_i weight_i value_i with its sigma, the correlations counted.
  [[nodiscard]] Measured combined(const std::vector<double>& weight) const;
};

/// The residuals (measured - model, each divided by its expected noise if that differs) at these parameters; always the
/// same number of them.
using Residuals = std::function<std::vector<double>(const std::vector<double>& parameters)>;

/// Levenberg-Marquardt [MAR63] from `start`, derivatives by central differences of `step`. The covariance is the
/// heteroscedasticity-consistent HC3 [MW85; physics §14.1], which needs no knowledge of the noise and errs on the wide
/// side for few readings, widened by Student's t for the degrees of freedom, so that 2 sigma hold 95 %. Throws
/// Fault::data, beginning with `subject`, when there are not more residuals than parameters, or the parameters cannot
/// be distinguished.
[[nodiscard]] CurveFit fit_curve(const Residuals& residuals, std::vector<double> start, const std::vector<double>& step,
                                 const std::string& subject);

/// The parts of the columns whose sum comes nearest to `values`. rows: row-major, a row for each value, n columns.
[[nodiscard]] std::vector<double> linear_fit(const std::vector<double>& rows, std::size_t n,
                                             const std::vector<double>& values);

/// What these parts of the columns sum up to, a number for each row.
[[nodiscard]] std::vector<double> sums_of(const std::vector<double>& rows, const std::vector<double>& parts);

}  // namespace vam::stats
