// The dose that a corrected column should have at every node, in closed form [CURE19 fig 3, constraints i-iii].
//
// Outside features: the pointwise least dose, max(fall, rise). `fall` decays from 1 at the top edge of the feature
// below at the minimum intensity (constraint iii); `rise` is the latest start that still reaches 1 at the bottom edge
// of the feature above at the maximum intensity (constraint ii).
// Inside features: the pointwise greatest dose that both edges and omega_max allow, min(fill, drain, omega_max). `fill`
// leaves the bottom edge at the maximum rate; `drain` is what the minimum intensity still brings down to 1 at the top.
// Neighbouring values always differ by a step that some Phi in [phi_min, phi_max] makes, because each of the four
// curves is such a sequence and the step is monotone in the dose; so the exact solution needs no search. With
// omega_max = 1 it is the least dose of all feasible columns, at every node at once.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "resin/curethrough/curethrough.hpp"

namespace vam::resin {

/// How much dose features may get.
struct DoseLimit {
  double omega_max = 1;  // at least 1, or infinite
  /// Features that stand on the platform have no resin behind them that could cure: they get the maximum intensity
  /// from their bottom edge on, whatever omega_max is, as the rails of [CURE19 fig 4] do.
  bool strong_base = false;
};

/// Every curve is tabulated by its distance from an edge, so that a node costs two look-ups:
/// Omega = |min(table[below - node], table[above + node])|. Values outside features are stored negative, which turns
/// the maximum into a minimum. `below` and `above` change only where the column passes an edge.
class TargetDose {
 public:
  /// For columns of up to `slices` slices, the extra ones included. Throws Fault::usage when omega_max is below 1.
  TargetDose(const CureLimits& limits, const DoseLimit& limit, int slices);

  [[nodiscard]] const double* table() const { return values_.data(); }
  [[nodiscard]] int slices() const { return slices_; }

  // Offsets for a node inside a feature of the nodes first..last; one that begins at node 0 stands on the platform.
  [[nodiscard]] int below_inside(int first, int last) const {
    return section(first == 0 && strong_base_ ? strong : fill) + last;
  }
  [[nodiscard]] int above_inside(int first) const { return first == 0 ? section(open) : section(drain) - first; }
  // Offsets for a node outside, before the feature whose first node is `next`, after the one whose last node is `last`.
  [[nodiscard]] int below_outside(int next) const { return section(fall) + next; }
  [[nodiscard]] int above_outside(int last) const { return section(rise) - last; }
  [[nodiscard]] int below_dark() const { return section(dark) + slices_; }  ///< no feature further down
  [[nodiscard]] int above_none() const { return section(none); }            ///< no feature further up

 private:
  enum Stretch { fill, strong, drain, open, fall, rise, dark, none, sections };
  [[nodiscard]] int section(Stretch s) const { return static_cast<int>(s) * (slices_ + 1); }
  int slices_;
  bool strong_base_;
  std::vector<double> values_;
};

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
