// SPDX-License-Identifier: GPL-3.0-or-later
// The resin's sensitivity, by which it cures ahead of its dose or behind it: a smooth field, fitted to the scattering
// in the views, and taken into account by the light that is left [physics §14.7].
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"

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

/// ln(dose that acts / planned dose): the polynomial of second degree in the place, relative to a box; and where the
/// projector has the axis, beside the column that the plan has. Eleven numbers with a normal distribution. Places in
/// mm, in the frame of the dose.
struct SensitivityField {
  static constexpr int terms = 10;  // 1, x, y, z, x^2, y^2, z^2, xy, xz, yz
  static constexpr int numbers = terms + 1;
  static constexpr double certain_px = 1e-6;  // of an axis that is where it is
  using Terms = std::array<double, terms>;

  std::array<double, 3> centre_mm{};
  std::array<double, 3> half_mm{1, 1, 1};
  Terms value{};
  double axis_px = 0;              // from projector.axis_column to the axis, in columns
  std::vector<double> covariance;  // row-major, numbers x numbers

  [[nodiscard]] Terms basis(double x_mm, double y_mm, double z_mm) const;
  [[nodiscard]] double log_at(double x_mm, double y_mm, double z_mm) const;
  [[nodiscard]] double axis_sigma_px() const;
  /// Standard deviation of log_at().
  [[nodiscard]] double sigma_at(double x_mm, double y_mm, double z_mm) const;
};

/// Prior of the field: no deviation, with these standard deviations of the whole (lamp, critical dose) and of each
/// further term.
struct SensitivityPrior {
  double whole = 0.3;
  double term = 0.1;
  double axis_px = 0;   // of the axis; 0: it is where the plan has it
  double drift = 0.01;  // of every term from one turn to the next
};
/// Its box is that of doses above half of the critical one. Throws Fault::data where there are none.
[[nodiscard]] SensitivityField expected_sensitivity(const model::Volume& dose, const ScatterCurve& curve,
                                                    const SensitivityPrior& prior);
/// The field's prediction for the next turn.
[[nodiscard]] SensitivityField carried_on(SensitivityField field, const SensitivityPrior& prior);

/// A planned dose, mJ/cm3, in the stretched frame. Of three it is the parabola through them: with the axis at
/// middle_px - offset_px, middle_px and middle_px + offset_px.
struct PlannedDose {
  std::vector<model::Volume> at;  // one, or three of one grid
  double offset_px = 1;
  double middle_px = 0;

  /// Weights of the three.
  [[nodiscard]] std::array<double, 3> weights(double axis_px) const;
  [[nodiscard]] model::Volume with(double axis_px) const;
  [[nodiscard]] const model::Volume& middle() const { return at[at.size() / 2]; }
};

/// Dose that had acted in the middle of the turn of views, of a part that was stretched along z.
struct ActedDose {
  const PlannedDose& dose;
  double stretch_z = 1;
};

struct SensitivityFit {
  SensitivityField field;
  double rms = 0;        // of the residuals, in their standard deviations
  double explained = 0;  // RMS of the densities that the field leaves, over what the previous one leaves
  long voxels = 0;       // that scatter, or should, by 10 to 90 % of the saturation
};

/// The most probable field, by the densities of a turn and what was known before. sigma: of each voxel by the noise of
/// the views, or nullptr. resolution_mm: standard deviation of what blurs the densities. Throws Fault::data where
/// scatter and doses have no place in common.
[[nodiscard]] SensitivityFit fit_sensitivity(const model::Volume& scatter, const model::Volume* sigma,
                                             const ActedDose& dose, const ScatterCurve& curve,
                                             const SensitivityField& before, double resolution_mm);

/// The dose that, completed by planned light to the critical one, is so much that what acts is the critical one: D +
/// D_c (1 - 1 / s), not below 0.
[[nodiscard]] model::Volume delivered_dose(const model::Volume& planned, const SensitivityField& field,
                                           double critical_dose_mj_cm3);

/// Over the voxels with at least half of the critical dose.
struct SensitivityRange {
  double low = 1;  // factors on the planned dose
  double mean = 1;
  double high = 1;
  double sigma = 0;  // relative, the largest
};
[[nodiscard]] SensitivityRange range_of(const SensitivityField& field, const model::Volume& dose,
                                        double critical_dose_mj_cm3);

struct CorrectionLimits {
  double sigma = 0.03;     // relative uncertainty of the sensitivity
  double deviation = 0.5;  // of its logarithm
  double rms = 3;          // of the residuals, in their standard deviations
  double change = 0.05;    // of its mean since the previous field, beyond three standard deviations of that
};
/// Reasons to reject the fit, a phrase each; empty: none. before: of the previous field.
[[nodiscard]] std::vector<std::string> doubts(const SensitivityFit& fit, const SensitivityRange& range,
                                              const SensitivityRange& before, const CorrectionLimits& limits);

[[nodiscard]] Json to_json(const SensitivityField& field);
/// Throws Fault::data, without a subject, for anything but what to_json() made.
[[nodiscard]] SensitivityField sensitivity_field(const Json& json);

}  // namespace vam::metrology
