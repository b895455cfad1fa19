// SPDX-License-Identifier: GPL-3.0-or-later
// Splits a value by stage angle into constant and once-per-turn parts: a vial whose middle circles the rotation axis is
// seen beside it at any one angle.
#pragma once

#include <string>
#include <vector>

#include "base/stats/measured.hpp"

namespace vam::metrology {

/// Between two stage angles of a turn; 360 where there is one or none.
[[nodiscard]] double widest_gap_deg(std::vector<double> angles_deg);

/// value = mean + radius * cos(theta - phase); units of the value, degrees.
struct Wobble {
  stats::Measured mean;       // of a vial's middle: the rotation axis
  stats::Measured radius;     // of the circle, 0 or more
  stats::Measured phase_deg;  // stage angle at which the value is greatest, 0...360
};

/// Amplitude and phase of a cos(theta) + b sin(theta); sigmas by propagation.
[[nodiscard]] Wobble wobble_of(const stats::Measured& mean, const stats::Measured& a, const stats::Measured& b);

/// Least squares over the angles; the values' sigmas are propagated, and grow when the values scatter more than they
/// say. Throws Fault::data, beginning with `subject`, when the angles leave a gap of 180 degrees or more.
[[nodiscard]] Wobble find_wobble(const std::vector<double>& angle_deg, const std::vector<stats::Measured>& values,
                                 const std::string& subject);

}  // namespace vam::metrology
