// SPDX-License-Identifier: GPL-3.0-or-later
// How narrow a gap a resin can keep open at a speed: what a catalogue of resins is compared by.
#pragma once

#include <cstddef>

#include "base/image.hpp"
#include "resin/curethrough/column_dose.hpp"
#include "resin/curethrough/part_columns.hpp"

namespace vam::resin {

/// The least dose that can be reached anywhere in a gap of this many slices between two features, when both its edges
/// are at 1: the dose falls at phi_min from the feature below and rises at phi_max to the one above [CURE19 fig 3].
/// 1 when the gap has no node of its own, or when the light cannot fall or rise at all.
[[nodiscard]] double lowest_gap_dose(const CureLimits& limits, int slices);

/// The fewest slices of a gap in which the dose falls to `clear` (0 < clear < 1) somewhere; 0 when no gap does, because
/// the dark alone settles above it or the light is too weak to cure at all.
[[nodiscard]] int narrowest_gap(const CureLimits& limits, double clear);

/// The speed at which the maximum intensity only just keeps the full-cure dose: I_max / D_f when continuous. Below it
/// everything can be cured, the more slowly the narrower the gaps.
[[nodiscard]] double speed_limit_mm_h(const Process& process);

/// The gaps of a part that a print cannot keep open.
struct GapReport {
  std::size_t infeasible_columns = 0;  // columns for which no Phi satisfies all constraints: a gap of a single slice
  std::size_t infeasible_gaps = 0;
  std::size_t tight_columns =
      0;  // columns with a gap whose dose nowhere falls to `clear`, the infeasible ones included
  std::size_t tight_gaps = 0;
  double worst_dose = 0;  // largest of the least doses of all gaps; 1 where a gap is infeasible
  int narrowest = 0;      // slices of the narrowest gap in the part; 0 without gaps
  Image mask;             // per column: 0 fine, 1 tight, 2 infeasible
};

/// `clear` in (0, 1]. Gaps are between two features of a column.
[[nodiscard]] GapReport judge_gaps(const PartColumns& part, const CureLimits& limits, double clear);

}  // namespace vam::resin
