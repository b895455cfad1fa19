// SPDX-License-Identifier: GPL-3.0-or-later
// The scattering density of a resin against the dose that it was given, and the delay of the one after the other
// [physics §14.6].
#pragma once

#include <optional>
#include <vector>

#include "base/stats/measured.hpp"
#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// Voxels of one dose in the volume of one turn.
struct CuringReading {
  double dose_per_turn_mj_cm3 = 0;
  double first_turn = 0;  // of the views, in turns of the stage since the light came on
  double last_turn = 0;
  double scatter = 0;  // mean of the voxels, view units per mm
  double sigma = 0;    // of that mean
};

/// The voxels of a volume by their dose in so many equal classes up to the highest one, without the lowest tenth of it
/// and where it differs by a quarter of a class or more from that of a neighbouring voxel. The dose is that of a turn,
/// of a part that was stretched along z by stretch_z, none beyond its volume. Views of turns first_turn to last_turn.
[[nodiscard]] std::vector<CuringReading> curing_readings(const model::Volume& scatter, const model::Volume& dose,
                                                         double stretch_z, int classes, double first_turn,
                                                         double last_turn);

struct CuringCurve {
  stats::Measured critical_dose_mj_cm3;        // at which the density is the isovalue
  stats::Measured induction_dose_mj_cm3;       // at which the tangent at half of the saturation begins
  stats::Measured rate_per_mj_cm3;             // slope of that tangent, of the saturation
  stats::Measured saturation;                  // view units per mm
  std::optional<stats::Measured> delay_turns;  // of scattering after the light
  double isovalue = 0;
  double rms = 0;  // of the residuals, in their sigmas
  int readings = 0;
};

/// isovalue: none is half of the saturation, as [OST22 section S2] found it. lit_turns: after so many the light went
/// off. The delay is fitted where the readings are of several turns with light. Throws Fault::data where the readings
/// do not show the rise of the curve, or the critical dose to 10 %.
[[nodiscard]] CuringCurve fit_curing_curve(const std::vector<CuringReading>& readings, double lit_turns,
                                           std::optional<double> isovalue);

/// turn_s: duration of a turn, 0 if not known.
[[nodiscard]] Json to_json(const CuringCurve& curve, double turn_s);

}  // namespace vam::metrology
