// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/scatter_curve.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/text/json.hpp"

namespace vam::metrology {

namespace {

double positive(const Json& record, const char* key) {
  const auto found = record.find(key);
  if (found != record.end() && found->is_number() && found->get<double>() > 0) return found->get<double>();
  throw Error{Fault::data, std::string(key) + " is not a number above 0; use a record of vam-calibrate working-curve"};
}

}  // namespace

double ScatterCurve::density(double dose_mj_cm3) const {
  return 1 / (1 + std::exp((middle_mj_cm3 - dose_mj_cm3) / width_mj_cm3));
}

ScatterCurve scatter_curve(const Json& record) {
  ScatterCurve curve;
  curve.saturation = positive(record, "saturation");
  curve.width_mj_cm3 = 0.25 / positive(record, "rate_per_mj_cm3");  // the tangent's slope at D_0 is S / 4 w
  curve.critical_dose_mj_cm3 = positive(record, "critical_dose_mj_cm3");
  // At the isovalue I: D = D_0 + w ln(I / (S - I)).
  const double isovalue = positive(record, "isovalue");
  if (!(isovalue < curve.saturation)) throw Error{Fault::data, "isovalue is not below saturation; measure it again"};
  curve.middle_mj_cm3 =
      curve.critical_dose_mj_cm3 - curve.width_mj_cm3 * std::log(isovalue / (curve.saturation - isovalue));
  curve.critical_sigma_mj_cm3 = record.value("critical_dose_sigma_mj_cm3", 0.0);
  curve.delay_s = std::max(0.0, record.value("delay_s", 0.0));
  return curve;
}

}  // namespace vam::metrology
