// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose_spread.hpp"

#include <cmath>

namespace vam::model {

namespace {

/// Mean time from when light came to the end of what it made, or of the print.
double mean_age_s(const Resin& resin, double seconds) {
  if (!resin.dose_lifetime_s) return 0.5 * seconds;
  const double lifetime_s = *resin.dose_lifetime_s;
  const double lives = seconds / lifetime_s;
  if (lives < 1e-3) return seconds * (0.5 - lives / 6 * (1 - lives / 4));  // where the other form has no digits left
  return lifetime_s * (1 + std::expm1(-lives) / lives);
}

}  // namespace

double diffused_mm2(const Resin& resin, double seconds) {
  return 2 * resin.diffusion_mm2_s * mean_age_s(resin, seconds);
}

double spread_mm(const Resin& resin, double seconds) {
  return std::sqrt(resin.psf_mm * resin.psf_mm + diffused_mm2(resin, seconds));
}

}  // namespace vam::model
