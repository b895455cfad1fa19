// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/column_correction.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace vam::resin {

namespace {

// A run of equal nodes.
struct FeatureRun {
  int first;
  int last;
  bool inside;
};

std::vector<FeatureRun> runs_of(std::span<const std::uint8_t> nodes) {
  std::vector<FeatureRun> runs;
  for (int n = 0; n < count_of(nodes); ++n) {
    const bool inside = nodes[n] != 0;
    if (runs.empty() || runs.back().inside != inside) runs.push_back({n, n, inside});
    runs.back().last = n;
  }
  return runs;
}

// Target at every node of the column, by the look-up rule of TargetDose.
std::vector<double> targets(const std::vector<FeatureRun>& runs, const TargetDose& dose) {
  std::vector<double> target(static_cast<std::size_t>(dose.slices()) + 1);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const FeatureRun& run = runs[r];
    int below = 0;
    int above = 0;
    if (run.inside) {
      below = dose.below_inside(run.first, run.last);
      above = dose.above_inside(run.first);
    } else {
      below = r + 1 < runs.size() ? dose.below_outside(runs[r + 1].first) : dose.below_dark();
      above = r > 0 ? dose.above_outside(runs[r - 1].last) : dose.above_none();
    }
    for (int n = run.first; n <= run.last; ++n) {
      target[n] = std::fabs(std::min(dose.table()[below - n], dose.table()[above + n]));
    }
  }
  return target;
}

// The largest violation of constraints i-iii by the doses really reached.
double excess(const std::vector<FeatureRun>& runs, const std::vector<double>& omega, const DoseLimit& limit) {
  double worst = 0;
  for (const FeatureRun& run : runs) {
    const bool unlimited = limit.strong_base && run.first == 0;
    const double omega_max = unlimited ? unlimited_dose : limit.omega_max;
    for (int n = run.first; n <= run.last; ++n) {
      const double dose = omega[n];
      worst = std::max(worst, run.inside ? std::max(1 - dose, dose - omega_max) : dose - 1);
    }
    if (!run.inside) continue;
    worst = std::max(worst, omega[run.last] - 1);                      // Omega = 1 at both edges;
    if (run.first > 0) worst = std::max(worst, omega[run.first] - 1);  // the platform is none
  }
  return worst;
}

int single_slice_gaps(std::span<const std::uint8_t> part) {
  int count = 0;
  for (std::size_t n = 1; n + 1 < part.size(); ++n) count += part[n - 1] != 0 && part[n] == 0 && part[n + 1] != 0;
  return count;
}

}  // namespace

CorrectedColumn correct_column(std::span<const std::uint8_t> part, const CureLimits& limits, const DoseLimit& limit,
                               int extra_slices) {
  const int slices = count_of(part) + extra_slices;
  const TargetDose dose(limits, limit, slices);
  std::vector<std::uint8_t> nodes = nodes_of(part, limits.exposure);
  nodes.resize(slices + 1, 0);
  if (limits.exposure == ExposureMode::continuous && extra_slices == 0 && !part.empty()) nodes.back() = part.back();
  const std::vector<FeatureRun> runs = runs_of(nodes);
  const std::vector<double> target = targets(runs, dose);

  CorrectedColumn column;
  column.phi.resize(slices);
  column.omega.resize(slices + 1, 0.0);
  for (std::size_t n = column.phi.size(); n-- > 0;) {
    const double carried = limits.q * column.omega[n + 1];
    column.phi[n] = std::clamp((target[n] - carried) / limits.gain, limits.phi_min, limits.phi_max);
    column.omega[n] = limits.next(column.phi[n], column.omega[n + 1]);
  }
  column.worst_excess = excess(runs, column.omega, limit);
  column.fused_gaps = limits.exposure == ExposureMode::continuous ? single_slice_gaps(part) : 0;
  return column;
}

int extra_slices(int last_slice, int slices, const CureLimits& limits) {
  if (last_slice < 0) return 0;
  const int last_node = last_slice + (limits.exposure == ExposureMode::continuous ? 1 : 0);
  return std::max(0, last_node + burst_slices(limits) - slices);
}

int extra_slices(std::span<const std::uint8_t> part, const CureLimits& limits) {
  int last = count_of(part) - 1;
  while (last >= 0 && part[last] == 0) --last;
  return extra_slices(last, count_of(part), limits);
}

std::vector<double> plain_column(std::span<const std::uint8_t> part, const CureLimits& limits) {
  std::vector<double> phi(part.size());
  for (std::size_t n = 0; n < part.size(); ++n) phi[n] = part[n] != 0 ? limits.phi_max : limits.phi_min;
  return phi;
}

std::vector<std::uint8_t> nodes_of(std::span<const std::uint8_t> part, ExposureMode exposure) {
  std::vector<std::uint8_t> nodes(part.begin(), part.end());
  if (exposure == ExposureMode::layered) return nodes;
  nodes.push_back(0);
  for (std::size_t n = part.size(); n-- > 0;) {
    if (part[n] != 0) nodes[n + 1] = 1;
  }
  return nodes;
}

}  // namespace vam::resin
