// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/private/covariance.hpp"

#include <algorithm>

namespace vam::stats {

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

}  // namespace vam::stats
