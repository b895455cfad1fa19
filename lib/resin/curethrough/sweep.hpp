// SPDX-License-Identifier: GPL-3.0-or-later
// Parameter study: how much of the height error a correction removes, for a range of assumed full-cure doses and
// maximum doses [CURE19 fig 5c].
#pragma once

#include <cstdint>
#include <vector>

#include "resin/curethrough/cure_map.hpp"

namespace vam::resin {

/// A column with one feature of each height, in slices; before each a gap of the same height, and one after the last.
[[nodiscard]] std::vector<std::uint8_t> graded_ladder(const std::vector<int>& heights);

/// The conventional column: phi_max in the part, phi_min elsewhere.
[[nodiscard]] std::vector<double> plain_column(const std::vector<std::uint8_t>& part, const CureLimits& limits);

struct Study {
  Process process;                   // full_cure_dose_mj_cm3 is the dose that really cures: what the print is judged by
  double gel_dose_mj_cm3 = 0;        // D_c: what dose_factors multiply
  std::vector<double> dose_factors;  // assumed full-cure dose / D_c
  std::vector<double> omega_max;
};

struct SizeRatio {
  int height = 0;       // of the feature, slices
  double plain_um = 0;  // mean height error of the uncorrected print
  double corrected_um = 0;
  /// corrected / plain; 0 when both are 0.
  [[nodiscard]] double ratio() const { return plain_um > 0 ? corrected_um / plain_um : (corrected_um > 0 ? 1e9 : 0); }
};

struct StudyPoint {
  double dose_factor = 0;
  double omega_max = 0;
  bool printable = false;  // false: no exposure reaches this full-cure dose at this speed
  int extra_slices = 0;
  std::vector<SizeRatio> sizes;  // one per feature height in the part, rising
  double ratio = 0;              // of the summed errors
};

/// One point per pair, dose factors outermost. Throws Fault::usage for empty or non-positive lists.
[[nodiscard]] std::vector<StudyPoint> run_study(const std::vector<std::uint8_t>& part, const Study& study);

}  // namespace vam::resin
