// SPDX-License-Identifier: GPL-3.0-or-later
// The scattering density of a resin by the dose that has acted on it, as a record of vam-calibrate working-curve has
// it.
#pragma once

#include "base/text/json_fwd.hpp"

namespace vam::metrology {

/// S / (1 + e^{(D_0 - D) / w}) [physics §14.6].
struct ScatterCurve {
  double saturation = 0;            // S, view units per mm
  double middle_mj_cm3 = 0;         // D_0, at half of it
  double width_mj_cm3 = 0;          // w
  double critical_dose_mj_cm3 = 0;  // of the isovalue: the resin is solid from here on
  double critical_sigma_mj_cm3 = 0;
  double delay_s = 0;  // of scattering after the light; 0 where the record has none

  /// Over S.
  [[nodiscard]] double density(double dose_mj_cm3) const;
};

/// Throws Fault::data, without a subject, where a number is missing or not above 0.
[[nodiscard]] ScatterCurve scatter_curve(const Json& record);

}  // namespace vam::metrology
