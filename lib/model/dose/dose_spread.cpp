// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/dose_spread.hpp"

#include <cmath>

#include "base/log/log.hpp"
#include "base/text/text.hpp"

namespace vam::model {

namespace {

/// Mean time from when light came to the end of what it made, or of the dark after the print.
double mean_age_s(const Resin& resin, double seconds) {
  if (!resin.dose_lifetime_s) return 0.5 * seconds + resin.dark_s;
  const double lifetime_s = *resin.dose_lifetime_s;
  const double lives = seconds / lifetime_s;
  const double lit_s = lives < 1e-3
                           ? seconds * (0.5 - lives / 6 * (1 - lives / 4))  // the other form has no digits left
                           : lifetime_s * (1 + std::expm1(-lives) / lives);
  return lit_s * std::exp(-resin.dark_s / lifetime_s) - lifetime_s * std::expm1(-resin.dark_s / lifetime_s);
}

}  // namespace

double diffused_mm2(const Resin& resin, double seconds) {
  return 2 * resin.diffusion_mm2_s * mean_age_s(resin, seconds);
}

double spread_mm(const Resin& resin, double seconds) {
  return std::sqrt(resin.psf_mm * resin.psf_mm + diffused_mm2(resin, seconds));
}

void warn_of_diffusion(const Resin& resin, double seconds) {
  const double variance_mm2 = diffused_mm2(resin, seconds);
  if (!(variance_mm2 > 0)) return;
  [[maybe_unused]] static const bool warned = [&] {
    warn("resin.diffusion_mm2_s: blurs the dose as what absorbed it diffuses, " +
         format_number(std::sqrt(variance_mm2), 2) + " mm (sigma) in " + format_number(seconds, 3) +
         " s; it does not stand for oxygen, which inhibits and needs a model of a resin that reacts");
    return true;
  }();
}

}  // namespace vam::model
