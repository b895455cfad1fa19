// SPDX-License-Identifier: GPL-3.0-or-later
// Absolute dose: what the relative one, integral I e^{-mu s} dtheta of intensities between 0 and 1, is in mJ/cm3
// [CAL19 eq 1; physics §4].
#pragma once

#include <optional>

#include "model/printer.hpp"

namespace vam::resin {

/// Dose in mJ/cm3 of one turn in full light from everywhere, per radian: (mu / Omega) I, mu in 1/cm, I in mW/cm2, Omega
/// in rad/s. Empty unless the resin has a critical dose and absorbs: then doses stay relative.
[[nodiscard]] std::optional<double> dose_per_radian_mj_cm3(const model::Printer& printer);

}  // namespace vam::resin
