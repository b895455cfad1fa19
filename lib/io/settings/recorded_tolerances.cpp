// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/recorded_tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/csv_table.hpp"

namespace vam::io {

namespace {

using model::ToleranceKind;

constexpr double sigmas = 2;
constexpr double sigma_of_fwhm = 2.354820045;  // of a Gaussian

double sigma(const CalibrationRecord& record, const std::string& name) {
  try {
    const double value = record.sigma(name);
    if (std::isfinite(value) && value >= 0) return value;
  } catch (const Json::exception&) {
  }
  throw Error{Fault::data, record.path + ": has no standard deviation of " + name + "; run vam-calibrate"};
}

/// All 0 where there is none.
model::Tolerances of_records(const model::Printer& printer) {
  const model::Calibration& calibration = printer.calibration;
  model::Tolerances found{};
  const auto set = [&](ToleranceKind what, double one_sigma) {
    found[static_cast<std::size_t>(what)] = sigmas * one_sigma;
  };
  if (const auto edges = current_record(calibration, "edges")) {
    set(ToleranceKind::axis, sigma(*edges, "axis_column"));
    set(ToleranceKind::radius, 100 * sigma(*edges, "radius") / printer.vial.radius_mm);
  }
  if (const auto latency = current_record(calibration, "latency")) {
    set(ToleranceKind::angle, 1e-3 * sigma(*latency, "latency") * printer.stage.speed_deg_s);
  }
  if (const auto beam = current_record(calibration, "beam"))
    set(ToleranceKind::psf, sigma(*beam, "axis_fwhm") / sigma_of_fwhm);
  return found;
}

}  // namespace

model::Tolerances recorded_tolerances(const model::Printer& printer) {
  const model::Calibration& calibration = printer.calibration;
  if (calibration.folder.empty()) {
    throw Error{Fault::usage,
                "calibration: no calibration.folder in the printer settings; set one, or give "
                "the tolerances"};
  }
  const model::Tolerances found = of_records(printer);
  if (std::any_of(found.begin(), found.end(), [](double one) { return one > 0; })) return found;
  throw Error{Fault::data, calibration.folder + ": has no record of edges, latency or beam; run vam-calibrate"};
}

model::Tolerances expected_tolerances(const model::Printer& printer) {
  const bool recorded = !printer.calibration.folder.empty();
  model::Tolerances expected = recorded ? of_records(printer) : model::Tolerances{};
  if (const auto wobble_mm = recorded ? wobble_in_force_mm(printer.calibration) : std::nullopt) {
    for (const auto kind : {ToleranceKind::vial_x, ToleranceKind::vial_y})
      expected[static_cast<std::size_t>(kind)] = *wobble_mm;
  }
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (expected[i] == 0) expected[i] = model::tolerance_table[i].typical;
  return expected;
}

}  // namespace vam::io
