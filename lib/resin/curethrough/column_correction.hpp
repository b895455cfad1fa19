// SPDX-License-Identifier: GPL-3.0-or-later
// The slices that give one column of voxels its target dose, solved from the last slice upwards [CURE19 eq 5].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "resin/curethrough/column_dose.hpp"
#include "resin/curethrough/target_dose.hpp"

namespace vam::resin {

/// One corrected column.
struct CorrectedColumn {
  std::vector<double> phi;    // per slice, the extra ones included; every value in [phi_min, phi_max]
  std::vector<double> omega;  // per node, phi.size() + 1 values
  int fused_gaps = 0;         // gaps of a single slice: there is no node in which the dose could fall below 1
  double worst_excess = 0;    // the largest violation of a constraint, in Omega
  [[nodiscard]] bool feasible() const { return fused_gaps == 0 && worst_excess <= dose_tolerance; }
};

/// The exact solution for part[n] = "slice n is in the part", followed by extra_slices empty slices. When no Phi
/// satisfies every constraint the column is marked infeasible and holds the nearest attempt; nothing is clipped
/// silently.
[[nodiscard]] CorrectedColumn correct_column(std::span<const std::uint8_t> part, const CureLimits& limits,
                                             const DoseLimit& limit, int extra_slices);

/// Slices after the part's own that the burst below its last feature needs; 0 for an empty column or without a burst.
[[nodiscard]] int extra_slices(std::span<const std::uint8_t> part, const CureLimits& limits);
/// The same for a part of `slices` slices whose deepest one in the part is last_slice (-1: none).
[[nodiscard]] int extra_slices(int last_slice, int slices, const CureLimits& limits);

/// The conventional column: phi_max in the part, phi_min elsewhere.
[[nodiscard]] std::vector<double> plain_column(std::span<const std::uint8_t> part, const CureLimits& limits);

/// Nodes of a column: 1 inside a feature. part.size() + 1 nodes when continuous, part.size() when layered.
[[nodiscard]] std::vector<std::uint8_t> nodes_of(std::span<const std::uint8_t> part, ExposureMode exposure);

}  // namespace vam::resin
