// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/diffused_dose.hpp"

#include <cmath>

namespace vam::oracle {

double diffused_dose(const SlitPrint& print, double x_mm) {
  constexpr int arrivals = 10000;
  double sum = 0;
  for (int i = 0; i < arrivals; ++i) {
    const double age_s = print.seconds * (i + 0.5) / arrivals;
    const double reach_mm = std::sqrt(4 * print.diffusion_mm2_s * age_s);
    sum += (std::erf((print.slit_mm / 2 - x_mm) / reach_mm) + std::erf((print.slit_mm / 2 + x_mm) / reach_mm)) / 2;
  }
  return sum / arrivals;
}

}  // namespace vam::oracle
