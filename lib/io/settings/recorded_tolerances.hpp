// SPDX-License-Identifier: GPL-3.0-or-later
// How far a printer may be from its settings, by its calibration records.
#pragma once

#include "model/printer.hpp"
#include "model/tolerances.hpp"

namespace vam::io {

/// Twice the standard deviation of what the current records of printer.calibration measured, which 95 % of such
/// measurements are within: axis and radius (edges), angle (latency, times the stage's speed), psf (the width at the
/// axis of beam). 0: not recorded; no scan measures the index or the lamp. Throws Fault::usage without
/// calibration.folder, Fault::data for a record that lacks a value, and when there is none of the three, what
/// current_record() throws.
[[nodiscard]] model::Tolerances recorded_tolerances(const model::Printer& printer);

/// Of each quantity what the records say, and eccentricity by the wobble in force; where they say nothing, or there is
/// no folder, what is typical.
[[nodiscard]] model::Tolerances expected_tolerances(const model::Printer& printer);

}  // namespace vam::io
