// SPDX-License-Identifier: GPL-3.0-or-later
// A resin's working curve: cured thickness = h_a log10(E / E_c), E the exposure at the surface [CURE19 fig 5a;
// JACO92; physics §14.4].
#pragma once

#include <span>
#include <vector>

namespace vam::resin {

struct CuredSample {
  double exposure_mj_cm2 = 0;
  double thickness_um = 0;
};

struct Interval {
  double low = 0;
  double high = 0;
};

/// Least squares of the thickness on log10 of the exposure. Every logarithm of exposure is to base 10, so that h_a is
/// the depth in which light falls to a tenth; Jacobs' penetration depth, to 1/e, is h_a / ln(10).
struct WorkingCurve {
  double absorbance_height_um = 0;      // h_a, the slope
  Interval absorbance_height_range_um;  // confidence intervals
  double critical_exposure_mj_cm2 = 0;  // E_c, where the thickness is 0
  Interval critical_exposure_range_mj_cm2;
  double gel_dose_mj_cm3 = 0;  // D_c = ln(10) E_c / h_a: the dose at the surface under E_c
  Interval gel_dose_range_mj_cm3;
  double penetration_depth_um = 0;  // D_p = h_a / ln(10)
  double confidence = 0.95;
  int samples = 0;
  int exposures = 0;          // distinct ones
  double residual_sd_um = 0;  // about the line
  double repeat_sd_um = 0;    // between repeats of one exposure; 0 without repeats
  double lack_of_fit_p = 1;   // small: the means leave the line by more than the repeats scatter; 1 without repeats
  double r_squared = 0;
  std::vector<double> residual_um;  // of every sample, in the order given
  std::vector<bool> outlier;        // flagged and kept: the deleted residual is beyond Bonferroni's 5 % bound
};

/// confidence in (0, 1). E_c by Fieller's theorem [FIE54], exact for normal errors, D_c by the delta method on
/// its logarithm. Throws Fault::data: fewer than three distinct exposures, values not positive, thickness that does not
/// rise.
[[nodiscard]] WorkingCurve fit_working_curve(std::span<const CuredSample> samples, double confidence = 0.95);

}  // namespace vam::resin
