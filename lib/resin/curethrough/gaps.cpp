// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/compute/parallel.hpp"

namespace vam::resin {

double lowest_gap_dose(const CureLimits& limits, int slices) {
  const double lowest = limits.settled(limits.phi_min);
  const double highest = limits.settled(limits.phi_max);
  if (!(lowest < 1 && highest > 1)) return 1;
  const int nodes = limits.exposure == ExposureMode::continuous ? slices - 1 : slices;
  double least = 1;
  for (int d = 1; d <= nodes; ++d) {  // d nodes above the lower feature, nodes + 1 - d below the upper one
    const double fall = lowest + (1 - lowest) * std::pow(limits.q, d);
    const double power = std::pow(limits.q, nodes + 1 - d);
    const double rise = (1 - highest * (1 - power)) / power;
    least = std::min(least, std::max({fall, rise, 0.0}));
  }
  return least;
}

int narrowest_gap(const CureLimits& limits, double clear) {
  const double lowest = limits.settled(limits.phi_min);
  if (!(lowest < clear) || !(limits.settled(limits.phi_max) > 1)) return 0;
  int high = 2;
  while (lowest_gap_dose(limits, high) > clear) {
    if (high > 1 << 20) return 0;
    high *= 2;
  }
  int low = 1;  // not enough
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (lowest_gap_dose(limits, middle) > clear ? low : high) = middle;
  }
  return low == 1 && limits.exposure == ExposureMode::layered && lowest_gap_dose(limits, 1) <= clear ? 1 : high;
}

double speed_limit_mm_h(const Process& process) {
  Process at_one = process;
  at_one.speed_mm_h = 1;
  const CureLimits limits = limits_of(at_one);  // Phi falls as 1 / speed
  return limits.settled(limits.phi_max);
}

namespace {

/// The gaps of a column; returns 2 where one fuses, 1 where one is tight. `least`: lowest dose by the length of a gap.
float judge_column(const PartColumns& part, std::size_t column, const std::vector<double>& least, double clear,
                   GapReport& report) {
  float verdict = 0;
  int end = part.next_slice(column, part.next_slice(column, 0, true), false);
  for (int begin = part.next_slice(column, end, true); begin < part.slices();
       begin = part.next_slice(column, end, true)) {
    const double dose = least[begin - end];
    const bool tight = dose > clear || dose >= 1;
    report.infeasible_gaps += dose >= 1;
    report.tight_gaps += tight;
    report.worst_dose = std::max(report.worst_dose, dose);
    report.narrowest = report.narrowest == 0 ? begin - end : std::min(report.narrowest, begin - end);
    verdict = std::max(verdict, dose >= 1 ? 2.0F : (tight ? 1.0F : 0.0F));
    end = part.next_slice(column, begin, false);
  }
  report.infeasible_columns += verdict == 2;
  report.tight_columns += verdict > 0;
  return verdict;
}

void add(const GapReport& row, GapReport& report) {
  report.infeasible_columns += row.infeasible_columns;
  report.infeasible_gaps += row.infeasible_gaps;
  report.tight_columns += row.tight_columns;
  report.tight_gaps += row.tight_gaps;
  report.worst_dose = std::max(report.worst_dose, row.worst_dose);
  if (row.narrowest > 0) {
    report.narrowest = report.narrowest == 0 ? row.narrowest : std::min(report.narrowest, row.narrowest);
  }
}

}  // namespace

GapReport judge_gaps(const PartColumns& part, const CureLimits& limits, double clear) {
  const int slices = part.slices();
  std::vector<double> least(static_cast<std::size_t>(slices) + 1, 1.0);  // by the length of the gap
  for (int gap = 1; gap <= slices; ++gap) {
    // Wider gaps reach ever less; beyond the first that reaches the limit of the light nothing changes.
    least[gap] = gap > 2 && least[gap - 1] == 0 ? 0 : lowest_gap_dose(limits, gap);
  }
  GapReport report;
  report.mask = Image(part.width(), part.height());
  std::vector<GapReport> rows(part.height());
  parallel_for(part.height(), [&](int y) {
    for (int x = 0; x < part.width(); ++x) {
      report.mask(x, y) = judge_column(part, report.mask.index(x, y), least, clear, rows[y]);
    }
  });
  for (const GapReport& row : rows) add(row, report);
  return report;
}

}  // namespace vam::resin
