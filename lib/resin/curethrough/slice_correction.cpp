// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/slice_correction.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/compute/simd.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "resin/curethrough/private/correction_kernel.hpp"

namespace vam::resin {

namespace {

const CorrectionKernels& kernels() { return VAM_KERNEL(correction_kernels, simd_level()); }

constexpr int guess_bins = 4096;

}  // namespace

ColumnCursor::ColumnCursor(const PartColumns& part, const TargetDose& dose)
    : part_(part),
      dose_(dose),
      below_(part.columns()),
      above_(part.columns()),
      first_(part.columns()),
      last_(part.columns()) {}

void ColumnCursor::place_column(std::size_t column, int node) {
  const bool beyond = node >= part_.nodes();  // the extra slices
  NodeRun run = part_.run(column, beyond ? part_.nodes() - 1 : node);
  if (beyond && run.inside) run = {run.last + 1, run.last + 1, false};
  if (!run.inside && run.last >= part_.nodes() - 1) run.last = dose_.slices();
  first_[column] = run.first;
  last_[column] = run.last;
  if (run.inside) {
    below_[column] = dose_.below_inside(run.first, run.last);
    above_[column] = dose_.above_inside(run.first);
  } else {
    below_[column] = run.last == dose_.slices() ? dose_.below_dark() : dose_.below_outside(run.last + 1);
    above_[column] = run.first == 0 ? dose_.above_none() : dose_.above_outside(run.first - 1);
  }
}

void ColumnCursor::place(int y, int node) {
  for (std::size_t p = start(y); p < start(y + 1); ++p) place_column(p, node);
}

void ColumnCursor::step_down(int y, int node) {
  if (!kernels().any_equal(last_.data() + start(y), node - 1, part_.width())) return;
  for (std::size_t p = start(y); p < start(y + 1); ++p) {
    if (last_[p] == node - 1) place_column(p, node);
  }
}

void ColumnCursor::step_up(int y, int node) {
  if (!kernels().any_equal(first_.data() + start(y), node + 1, part_.width())) return;
  for (std::size_t p = start(y); p < start(y + 1); ++p) {
    if (first_[p] == node + 1) place_column(p, node);
  }
}

void require_printable(const CureLimits& limits) {
  if (limits.settled(limits.phi_min) >= 1) {
    throw Error{Fault::data, "intensity range: the minimum alone settles at " +
                                 format_number(limits.settled(limits.phi_min), 3) +
                                 " full-cure doses, so everything cures; increase contrast or print faster"};
  }
  if (burst_slices(limits) == 0) {
    const double highest = limits.settled(limits.phi_max);
    throw Error{Fault::data, "intensity range: the maximum settles at " + format_number(highest, 3) +
                                 " full-cure doses, so nothing cures; increase the intensity, or print at " +
                                 format_number(highest, 3) + " times this speed or slower"};
  }
}

SliceCorrection::SliceCorrection(const PartColumns& part, const CureLimits& limits, const DoseLimit& limit, int slices)
    : part_(part), limits_(limits), dose_(limits, limit, slices), cursor_(part, dose_), omega_(part.columns()) {
  parallel_for(part_.height(), [&](int y) {
    cursor_.place(y, 0);
    const std::size_t start = product(y, part_.width());
    for (int x = 0; x < part_.width(); ++x) {
      const double low = dose_.table()[cursor_.below(y)[x]];
      const double high = dose_.table()[cursor_.above(y)[x]];
      omega_[start + x] = std::fabs(std::min(low, high));
    }
  });
}

void SliceCorrection::next(Image& slice) {
  if (done_ == slices()) throw Error{Fault::bug, "slice correction: all slices are done"};
  if (slice.width != part_.width() || slice.height != part_.height()) slice = Image(part_.width(), part_.height());
  const int node = ++done_;
  const CorrectionKernels& kernel = kernels();
  parallel_for(part_.height(), [&](int y) {
    cursor_.step_down(y, node);
    kernel.forward({dose_.table(), cursor_.below(y), cursor_.above(y), omega_.data() + product(y, part_.width()),
                    slice.row(y), part_.width(), node, limits_.q, limits_.gain, limits_.phi_min, limits_.phi_max});
  });
}

LevelCorrection::LevelCorrection(const PartColumns& part, const CureLimits& limits, const DoseLimit& limit, int slices,
                                 std::span<const float> levels)
    : part_(part),
      limits_(limits),
      dose_(limits, limit, slices),
      cursor_(part, dose_),
      first_guess_(guess_bins + 1),
      omega_(part.columns()),
      left_(slices) {
  if (levels.size() < 2 || levels.size() > 65536 || !std::is_sorted(levels.begin(), levels.end())) {
    throw Error{Fault::data, "grey levels: " + std::to_string(levels.size()) +
                                 " intensities that do not rise; give 2 to 65536 rising ones"};
  }
  for (const float level : levels) phi_.push_back(static_cast<double>(level) * limits.phi_max);
  std::size_t lowest = 0;
  for (int bin = 0; bin <= guess_bins; ++bin) {
    const double phi = limits.phi_max * bin / guess_bins;
    while (lowest + 1 < phi_.size() && phi_[lowest] < phi) ++lowest;
    // One below, so that rounding of the bin number cannot skip the right level.
    first_guess_[bin] = static_cast<int>(lowest > 0 ? lowest - 1 : 0);
  }
  parallel_for(part_.height(), [&](int y) { cursor_.place(y, slices); });
}

// The lowest level with at least this Phi. Half the dose tolerance is rounding, not a reason for the next level.
int LevelCorrection::level_for(double phi) const {
  const double need = phi - 0.5 * dose_tolerance / limits_.gain;
  const double bin = std::clamp(need / limits_.phi_max * guess_bins, 0.0, static_cast<double>(guess_bins));
  int level = first_guess_[static_cast<std::size_t>(bin)];
  while (level + 1 < count_of(phi_) && phi_[level] < need) ++level;
  return level;
}

void LevelCorrection::previous(std::vector<std::uint16_t>& slice) {
  if (left_ == 0) throw Error{Fault::bug, "level correction: all slices are done"};
  slice.resize(part_.columns());
  const int node = --left_;
  const CorrectionKernels& kernel = kernels();
  parallel_for(part_.height(), [&](int y) {
    cursor_.step_up(y, node);
    const std::size_t start = product(y, part_.width());
    std::vector<float> wanted(part_.width());
    double* omega = omega_.data() + start;
    kernel.wanted({dose_.table(), cursor_.below(y), cursor_.above(y), omega, wanted.data(), part_.width(), node,
                   limits_.q, limits_.gain, limits_.phi_min, limits_.phi_max});
    for (int x = 0; x < part_.width(); ++x) {
      const int level = level_for(static_cast<double>(wanted[x]));
      slice[start + x] = static_cast<std::uint16_t>(level);
      omega[x] = limits_.next(phi_[level], omega[x]);
    }
  });
}

}  // namespace vam::resin
