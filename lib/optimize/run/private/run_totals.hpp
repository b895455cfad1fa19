// SPDX-License-Identifier: GPL-3.0-or-later
// Totals of a run over all passes.
#pragma once

#include <span>
#include <vector>

#include "model/dose/dose_metrics.hpp"
#include "optimize/methods/archive.hpp"
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/slice_figures.hpp"

namespace vam::optimize {

class RunTotals {
 public:
  /// Figures of one pass after this number of iterations.
  void note(int iteration, const SliceFigures& figures);
  /// A pass has ended with the figures it noted last.
  void end(const Outcome& outcome);
  void add_dark(std::int64_t voxels) { dark_part_voxels_ += voxels; }
  /// The doses of the pass's own jobs as they leave the optimiser: what they print and, unless the target is grey, what
  /// they leave outside the part's box. Passes come in ascending order.
  void add(std::span<const Slab> dose, const Problem& problem, const Pass& pass, const Jobs& jobs,
           const model::VoxelBox& part);
  void exchange(Archive& archive);
  /// Fills in what all passes together say of the dose. job_of_slice: as in Schedule.
  void complete(VolumeOutcome& outcome, bool grey, std::span<const int> job_of_slice) const;

 private:
  void add_outside(std::span<const Slab> dose, const Problem& problem, const Pass& pass, const Jobs& jobs,
                   const model::VoxelBox& part);

  std::vector<SliceFigures> rows_, ends_;  // per iteration: of passes that got there, of passes that ended there
  SliceFigures last_;
  int seen_ = -1;
  model::DoseStatistics total_, cut_;
  model::StrayCure outside_;
  SliceFigures figures_;
  std::vector<double> min_part_, max_void_;  // of each job; -1: none
  StopReason stop_ = StopReason::iterations;
  double growth_ = no_growth_known;
  int iterations_ = 0;
  std::int64_t dark_part_voxels_ = 0;
};

}  // namespace vam::optimize
