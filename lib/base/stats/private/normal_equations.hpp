// SPDX-License-Identifier: GPL-3.0-or-later
// Normal equations of least squares and their solution.
#pragma once

#include <cstddef>
#include <vector>

namespace vam::stats {

using Vector = std::vector<double>;

/// A symmetric positive definite matrix, row by row, scaled to a unit diagonal, as its Cholesky factor.
class Cholesky {
 public:
  Cholesky(Vector matrix, std::size_t n);
  /// False where it is not positive definite to 1e-12.
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] Vector solve(Vector b) const;

 private:
  std::size_t n_;
  Vector l_;
  Vector scale_;
  bool good_ = true;
};

/// sum_i weight_i j_i j_i^T, j row by row with n columns.
[[nodiscard]] Vector normal_matrix(const Vector& j, std::size_t n, const Vector& weight);

/// -J' r.
[[nodiscard]] Vector gradient(const Vector& j, std::size_t n, const Vector& residual);

}  // namespace vam::stats
