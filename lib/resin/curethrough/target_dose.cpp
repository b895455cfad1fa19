// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/target_dose.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::resin {

TargetDose::TargetDose(const CureLimits& limits, const DoseLimit& limit, int slices)
    : slices_(slices), strong_base_(limit.strong_base) {
  const double omega_max = limit.omega_max;
  if (!(omega_max >= 1)) {
    throw Error{Fault::usage, "omega-max: " + format_number(omega_max) +
                                  " is below 1, the dose that cures; give 1, more than 1, or inf"};
  }
  const double lowest = limits.settled(limits.phi_min);
  const double highest = limits.settled(limits.phi_max);
  values_.resize(sections * static_cast<std::size_t>(slices + 1));
  for (int d = 0; d <= slices; ++d) {
    const double power = std::pow(limits.q, d);
    const auto put = [&](Stretch s, double value) { values_[section(s) + d] = value; };
    const double drained = (1 - lowest * (1 - power)) / power;  // may overflow to inf: no limit
    const double filled = highest * (1 - power) + power;        // at least 1
    put(fill, std::min(filled, omega_max));
    put(strong, filled);
    put(drain, std::clamp(drained, 1.0, unlimited_dose));
    put(open, unlimited_dose);
    put(fall, -(lowest + (1 - lowest) * power));
    put(rise, std::clamp((highest * (1 - power) - 1) / power, -1.0, unlimited_dose));
    put(dark, -lowest * (1 - power));
    put(none, unlimited_dose);
  }
}

}  // namespace vam::resin
