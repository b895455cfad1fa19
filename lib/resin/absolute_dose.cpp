// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/absolute_dose.hpp"

#include "base/constants.hpp"

namespace vam::resin {

std::optional<double> dose_per_radian_mj_cm3(const model::Printer& printer) {
  constexpr double mm_per_cm = 10;
  const double mu_per_cm = printer.resin.absorption_per_mm * mm_per_cm;
  if (!printer.resin.critical_dose_mj_cm3 || !(mu_per_cm > 0)) return std::nullopt;
  const double omega_rad_s = printer.stage.speed_deg_s * rad_per_deg;
  return mu_per_cm / omega_rad_s * printer.projector.max_intensity_mw_cm2;
}

}  // namespace vam::resin
