// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/private/normal_equations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vam::stats {

Cholesky::Cholesky(Vector matrix, std::size_t n) : n_(n), l_(std::move(matrix)), scale_(n) {
  for (std::size_t i = 0; i < n; ++i) scale_[i] = l_[i * n + i] > 0 ? 1 / std::sqrt(l_[i * n + i]) : 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = l_[i * n + j] * scale_[i] * scale_[j];
      for (std::size_t k = 0; k < j; ++k) sum -= l_[i * n + k] * l_[j * n + k];
      if (i == j && !(sum > 1e-12)) good_ = false;
      l_[i * n + j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / l_[j * n + j];
    }
  }
}

Vector Cholesky::solve(Vector b) const {
  for (std::size_t i = 0; i < n_; ++i) {
    b[i] *= scale_[i];
    for (std::size_t k = 0; k < i; ++k) b[i] -= l_[i * n_ + k] * b[k];
    b[i] /= l_[i * n_ + i];
  }
  for (std::size_t i = n_; i-- > 0;) {
    for (std::size_t k = i + 1; k < n_; ++k) b[i] -= l_[k * n_ + i] * b[k];
    b[i] /= l_[i * n_ + i];
  }
  for (std::size_t i = 0; i < n_; ++i) b[i] *= scale_[i];
  return b;
}

Vector normal_matrix(const Vector& j, std::size_t n, const Vector& weight) {
  Vector matrix(n * n);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double* row = j.data() + i * n;
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < n; ++b) matrix[a * n + b] += weight[i] * row[a] * row[b];
    }
  }
  return matrix;
}

Vector gradient(const Vector& j, std::size_t n, const Vector& residual) {
  Vector sum(n);
  for (std::size_t i = 0; i < residual.size(); ++i) {
    for (std::size_t a = 0; a < n; ++a) sum[a] -= j[i * n + a] * residual[i];
  }
  return sum;
}

}  // namespace vam::stats
