// SPDX-License-Identifier: GPL-3.0-or-later
// Covariance of fitted parameters where the readings scatter unevenly [MW85].
#pragma once

#include "base/stats/private/normal_equations.hpp"

namespace vam::stats {

/// (J'J)^-1 J' diag(r^2 / (1 - h)^2) J (J'J)^-1, h the leverages (HC3); `normal` is J'J.
[[nodiscard]] Vector hc3(const Vector& j, std::size_t n, const Vector& residual, const Cholesky& normal);

}  // namespace vam::stats
