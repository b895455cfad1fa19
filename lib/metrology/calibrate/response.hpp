// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's response: a ramp of uniform grey levels, read by a camera or a photodiode [CAL17; physics §10].
#pragma once

#include <vector>

#include "base/stats/measured.hpp"

namespace vam::metrology {

/// Readings of each level, dark subtracted; levels rise from 0 to full grey.
struct ResponseScan {
  std::vector<double> grey;
  std::vector<std::vector<double>> light;
};

/// Intensity of each level as a part of that at full grey, never falling; the last is 1 by definition (sigma 0).
struct ResponseCurve {
  std::vector<double> grey;
  std::vector<stats::Measured> intensity;
};

/// The mean of each level's readings, made monotone by least squares (pool adjacent violators). Sigma is the standard
/// error of the readings, by Student's t. Throws Fault::data: fewer than 17 levels or 3 readings a level, levels that
/// do not rise from 0, no light, readings that fall against grey by more than the readings' scatter explains, or that
/// are the same from one of the last levels on, as those of a camera that saturates.
[[nodiscard]] ResponseCurve measure_response(const ResponseScan& scan);

}  // namespace vam::metrology
