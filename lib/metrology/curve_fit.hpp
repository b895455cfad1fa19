// Least squares for measurements: the parameters of a curve, and how well they are known.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace vam::metrology {

/// A measured number with one standard deviation, out of n readings. The unit is in the name of whatever holds it.
struct Measured {
  double value = 0;
  double sigma = 0;
  int n = 0;
};

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

/// Levenberg-Marquardt from `start`, derivatives by central differences of `step`. The covariance is the
/// heteroscedasticity-consistent HC3 of MacKinnon & White (J. Econometrics 29, 1985), which needs no knowledge of the
/// noise and errs on the wide side for few readings, widened by Student's t for the degrees of freedom, so that
/// 2 sigma hold 95 %. Throws Fault::data, beginning with `subject`, when there are not more residuals than parameters,
/// or the parameters cannot be told apart.
[[nodiscard]] CurveFit fit_curve(const Residuals& residuals, std::vector<double> start, const std::vector<double>& step,
                                 const std::string& subject);

/// The parts of the columns whose sum comes nearest to `values`. rows: row-major, a row for each value, n columns.
[[nodiscard]] std::vector<double> linear_fit(const std::vector<double>& rows, std::size_t n,
                                             const std::vector<double>& values);

/// Mean by weight 1/sigma^2; its sigma grows when the parts scatter more than they say.
[[nodiscard]] Measured weighted_mean(const std::vector<Measured>& parts);

/// y = at_zero + slope x by weight 1/sigma^2, at least two points; sigmas grow as those of weighted_mean().
struct WeightedLine {
  Measured at_zero;
  Measured slope;
};
[[nodiscard]] WeightedLine weighted_line(const std::vector<double>& x, const std::vector<Measured>& y);

/// The angle of a line that moves by slope * pitch along its length.
[[nodiscard]] Measured lean_deg(const Measured& slope, double pitch);

/// Student's t at 95 % over that of the normal distribution: the factor by which a standard error from few readings
/// grows.
[[nodiscard]] double few_readings_factor(int freedom);

}  // namespace vam::metrology
