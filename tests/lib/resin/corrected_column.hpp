// SPDX-License-Identifier: GPL-3.0-or-later
// The correction of one column, node by node and in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "resin/curethrough/column_dose.hpp"
#include "resin/curethrough/target_dose.hpp"

namespace vam::test {

using ColumnBits = std::vector<std::uint8_t>;  // 1 in the part

/// 1 inside a feature: planes between slices when continuous, else slices.
inline ColumnBits nodes_of(const ColumnBits& part, resin::ExposureMode exposure) {
  ColumnBits nodes = part;
  if (exposure == resin::ExposureMode::layered) return nodes;
  nodes.push_back(0);
  for (std::size_t n = 0; n < part.size(); ++n) nodes[n + 1] |= part[n];
  return nodes;
}

struct CorrectedColumn {
  std::vector<double> phi;    // per slice
  std::vector<double> omega;  // per node
};

/// The targets from the last slice up, as near as the light comes to them.
inline CorrectedColumn correct_column(const ColumnBits& part, const resin::CureLimits& limits,
                                      const resin::DoseLimit& limit, int extra_slices) {
  const int slices = static_cast<int>(part.size()) + extra_slices;
  const resin::TargetDose dose(limits, limit, slices);
  ColumnBits nodes = nodes_of(part, limits.exposure);
  nodes.resize(slices + 1, 0);
  CorrectedColumn column{std::vector<double>(slices), std::vector<double>(slices + 1, 0.0)};
  for (int n = slices; n-- > 0;) {
    const bool inside = nodes[n] != 0;
    int first = n, last = n;
    while (first > 0 && nodes[first - 1] == nodes[n]) --first;
    while (last < slices && nodes[last + 1] == nodes[n]) ++last;
    const int outside_below = last < slices ? dose.below_outside(last + 1) : dose.below_dark();
    const int outside_above = first > 0 ? dose.above_outside(first - 1) : dose.above_none();
    const int below = inside ? dose.below_inside(first, last) : outside_below;
    const int above = inside ? dose.above_inside(first) : outside_above;
    const double target = std::fabs(std::min(dose.table()[below - n], dose.table()[above + n]));
    column.phi[n] = std::clamp((target - limits.q * column.omega[n + 1]) / limits.gain, limits.phi_min, limits.phi_max);
    column.omega[n] = limits.next(column.phi[n], column.omega[n + 1]);
  }
  return column;
}

/// The constraints [physics §9] written out node by node, from phi alone; `slack` is rounding. Empty: they hold.
inline std::string violation(const ColumnBits& part, const std::vector<double>& phi, const resin::CureLimits& limits,
                             double omega_max) {
  const double slack = 1e-9;
  const int slices = static_cast<int>(phi.size());
  const auto solid = [&](int n) { return n >= 0 && n < static_cast<int>(part.size()) && part[n] != 0; };
  double omega = 0;
  for (int n = slices; n >= 0; --n) {
    if (n < slices) {
      const double value = phi[n];
      if (!(value >= limits.phi_min - slack && value <= limits.phi_max + slack)) return "Phi out of range";
      omega = limits.gain * value + limits.q * omega;
    }
    const bool here = solid(n);
    const bool before = limits.exposure == resin::ExposureMode::continuous && solid(n - 1);
    if (!here && !before) {
      if (omega >= 1) return "cured outside at node " + std::to_string(n);
      continue;
    }
    if (omega < 1 - slack) return "undercured at node " + std::to_string(n);
    if (omega > omega_max + slack) return "above omega_max at node " + std::to_string(n);
    const bool top_edge = here && n > 0 && !solid(n - 1);
    const bool bottom_edge = limits.exposure == resin::ExposureMode::continuous ? !here : !solid(n + 1);
    if ((top_edge || bottom_edge) && std::fabs(omega - 1) > slack) return "edge not at 1, node " + std::to_string(n);
  }
  return "";
}

}  // namespace vam::test
