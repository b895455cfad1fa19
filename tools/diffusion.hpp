// SPDX-License-Identifier: GPL-3.0-or-later
// What the diffusion of the dose stands for is not taken for more in silence.
#pragma once

#include <cmath>

#include "base/log.hpp"
#include "base/text.hpp"
#include "model/dose_spread.hpp"

namespace vam::tool {

/// Once a run, where the dose of a print of `seconds` is blurred by diffusion.
inline void warn_of_diffusion(const model::Resin& resin, double seconds) {
  const double variance_mm2 = model::diffused_mm2(resin, seconds);
  if (!(variance_mm2 > 0)) return;
  [[maybe_unused]] static const bool warned = [&] {
    warn("resin.diffusion_mm2_s: blurs the dose as what absorbed it diffuses, " +
         format_number(std::sqrt(variance_mm2), 2) + " mm (sigma) in " + format_number(seconds, 3) +
         " s; it does not stand for oxygen, which inhibits and needs a model of a resin that reacts");
    return true;
  }();
}

}  // namespace vam::tool
