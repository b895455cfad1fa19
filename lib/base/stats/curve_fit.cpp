// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/curve_fit.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/private/normal_equations.hpp"

namespace vam::stats {

namespace {

/// (J'J)^-1 J' diag(r^2 / (1 - h)^2) J (J'J)^-1, h the leverages (HC3); `normal` is J'J.
Vector hc3(const Vector& j, std::size_t n, const Vector& residual, const Cholesky& normal) {
  Vector weight(residual.size());
  for (std::size_t i = 0; i < residual.size(); ++i) {
    const Vector row(j.begin() + static_cast<std::ptrdiff_t>(i * n),
                     j.begin() + static_cast<std::ptrdiff_t>(i * n + n));
    const Vector solved = normal.solve(row);
    double leverage = 0;
    for (std::size_t a = 0; a < n; ++a) leverage += row[a] * solved[a];
    const double free = std::max(1 - leverage, 0.05);
    weight[i] = residual[i] * residual[i] / (free * free);
  }
  const Vector meat = normal_matrix(j, n, weight);
  Vector half(n * n);  // rows: (J'J)^-1 applied to the columns of the (symmetric) meat
  for (std::size_t a = 0; a < n; ++a) {
    const Vector solved = normal.solve(Vector(meat.begin() + static_cast<std::ptrdiff_t>(a * n),
                                              meat.begin() + static_cast<std::ptrdiff_t>(a * n + n)));
    for (std::size_t b = 0; b < n; ++b) half[b * n + a] = solved[b];
  }
  Vector covariance(n * n);
  for (std::size_t a = 0; a < n; ++a) {
    const Vector solved = normal.solve(Vector(half.begin() + static_cast<std::ptrdiff_t>(a * n),
                                              half.begin() + static_cast<std::ptrdiff_t>(a * n + n)));
    for (std::size_t b = 0; b < n; ++b) covariance[a * n + b] = solved[b];
  }
  return covariance;
}

double square_sum(const Vector& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return sum;
}

// d residual / d parameter, one row a residual.
Vector jacobian(const Residuals& residuals, const Vector& at, const Vector& step, std::size_t rows) {
  Vector j(rows * at.size());
  for (std::size_t p = 0; p < at.size(); ++p) {
    Vector up = at;
    Vector down = at;
    up[p] += step[p];
    down[p] -= step[p];
    const Vector high = residuals(up);
    const Vector low = residuals(down);
    for (std::size_t i = 0; i < rows; ++i) j[i * at.size() + p] = (high[i] - low[i]) / (2 * step[p]);
  }
  return j;
}

/// The parameters at which the sum of squares no longer falls, from `start` with its residuals [MAR63].
void descend(const Residuals& residuals, const Vector& step, Vector& start, Vector& residual) {
  const std::size_t n = start.size();
  const Vector ones(residual.size(), 1.0);
  double damping = 1e-3;
  for (int round = 0; round < 100; ++round) {
    const Vector j = jacobian(residuals, start, step, residual.size());
    Vector matrix = normal_matrix(j, n, ones);
    for (std::size_t a = 0; a < n; ++a) matrix[a * n + a] *= 1 + damping;
    const Vector change = Cholesky(matrix, n).solve(gradient(j, n, residual));
    Vector next = start;
    for (std::size_t a = 0; a < n; ++a) next[a] += change[a];
    Vector after = residuals(next);
    const double before_sum = square_sum(residual);
    const double after_sum = square_sum(after);
    if (after_sum <= before_sum) {
      start = std::move(next);
      residual = std::move(after);
      damping = std::max(damping / 10, 1e-12);
      if (before_sum - after_sum <= 1e-10 * before_sum) break;
    } else {
      damping *= 10;
      if (damping > 1e8) break;
    }
  }
}

}  // namespace

Vector linear_fit(const Vector& rows, std::size_t n, const Vector& values) {
  Vector matrix = normal_matrix(rows, n, Vector(values.size(), 1.0));
  for (std::size_t a = 0; a < n; ++a) matrix[a * n + a] *= 1 + 1e-10;  // two columns may be the same
  Vector parts = Cholesky(matrix, n).solve(gradient(rows, n, values));
  for (double& part : parts) part = -part;
  return parts;
}

Vector sums_of(const Vector& rows, const Vector& parts) {
  Vector sums(rows.size() / parts.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (std::size_t n = 0; n < parts.size(); ++n) sums[i] += rows[i * parts.size() + n] * parts[n];
  }
  return sums;
}

Measured CurveFit::combined(const Vector& weight) const {
  Measured out{0, 0, n};
  double variance = 0;
  for (std::size_t a = 0; a < value.size(); ++a) {
    out.value += weight[a] * value[a];
    for (std::size_t b = 0; b < value.size(); ++b) {
      variance += weight[a] * weight[b] * covariance[a * value.size() + b];
    }
  }
  out.sigma = std::sqrt(std::max(variance, 0.0));
  return out;
}

Measured CurveFit::measured(std::size_t i) const {
  Vector weight(value.size());
  weight[i] = 1;
  return combined(weight);
}

CurveFit fit_curve(const Residuals& residuals, Vector start, const Vector& step, const std::string& subject) {
  const std::size_t n = start.size();
  Vector residual = residuals(start);
  if (residual.size() <= n) {
    throw Error{Fault::data, subject + ": " + std::to_string(residual.size()) + " readings cannot give " +
                                 std::to_string(n) + " numbers; measure more"};
  }
  descend(residuals, step, start, residual);
  const Vector ones(residual.size(), 1.0);
  const Vector j = jacobian(residuals, start, step, residual.size());
  const Cholesky normal(normal_matrix(j, n, ones), n);
  if (!normal.good()) throw Error{Fault::data, subject + ": the readings do not determine the curve; measure more"};
  CurveFit fit;
  fit.value = start;
  fit.n = count_of(residual);
  fit.rms = std::sqrt(square_sum(residual) / static_cast<double>(fit.n));
  fit.covariance = hc3(j, n, residual, normal);
  const double factor = few_readings_factor(fit.n - static_cast<int>(n));
  for (double& entry : fit.covariance) entry *= factor * factor;
  return fit;
}

}  // namespace vam::stats
