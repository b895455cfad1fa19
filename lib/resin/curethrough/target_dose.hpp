// SPDX-License-Identifier: GPL-3.0-or-later
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

#include <vector>

#include "resin/curethrough/column_dose.hpp"

namespace vam::resin {

/// Stands for no limit, in values that are subtracted and compared.
inline constexpr double unlimited_dose = 1e300;

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
  /// For columns of up to `slices` slices, the extra ones included; the maximum intensity settles above the dose that
  /// cures. Throws Fault::usage when omega_max is below 1.
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

}  // namespace vam::resin
