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

void ColumnCursor::step(int y, int node, bool down) {
  const std::vector<int>& edges = down ? last_ : first_;
  const int left = down ? node - 1 : node + 1;
  if (!kernels().any_equal(edges.data() + start(y), left, part_.width())) return;
  for (std::size_t p = start(y); p < start(y + 1); ++p) {
    if (edges[p] == left) place_column(p, node);
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
    cursor_.step(y, node, true);
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
      omega_(part.columns()),
      left_(slices) {
  if (levels.size() < 2 || levels.size() > 65536 || !std::is_sorted(levels.begin(), levels.end())) {
    throw Error{Fault::data, "grey levels: " + std::to_string(levels.size()) +
                                 " intensities that do not rise; give 2 to 65536 rising ones"};
  }
  for (const float level : levels) phi_.push_back(static_cast<double>(level) * limits.phi_max);
  parallel_for(part_.height(), [&](int y) { cursor_.place(y, slices); });
}

void LevelCorrection::previous(std::vector<std::uint16_t>& slice) {
  if (left_ == 0) throw Error{Fault::bug, "level correction: all slices are done"};
  slice.resize(part_.columns());
  const int node = --left_;
  const CorrectionKernels& kernel = kernels();
  parallel_for(part_.height(), [&](int y) {
    cursor_.step(y, node, false);
    const std::size_t start = product(y, part_.width());
    std::vector<float> wanted(part_.width());
    double* omega = omega_.data() + start;
    kernel.wanted({dose_.table(), cursor_.below(y), cursor_.above(y), omega, wanted.data(), part_.width(), node,
                   limits_.q, limits_.gain, limits_.phi_min, limits_.phi_max});
    for (int x = 0; x < part_.width(); ++x) {
      // The lowest level that is enough; half the dose tolerance is rounding, not a reason for the next one.
      const double need = static_cast<double>(wanted[x]) - 0.5 * dose_tolerance / limits_.gain;
      const auto level = std::lower_bound(phi_.begin(), phi_.end() - 1, need) - phi_.begin();
      slice[start + x] = static_cast<std::uint16_t>(level);
      omega[x] = limits_.next(phi_[level], omega[x]);
    }
  });
}

}  // namespace vam::resin
