// SPDX-License-Identifier: GPL-3.0-or-later
// Totals of a run over all passes.
#pragma once

#include <span>
#include <vector>

#include "model/dose_metrics.hpp"
#include "optimize/methods/archive.hpp"
#include "optimize/run/slice_figures.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

class Ledger {
 public:
  /// Figures of one pass after so many iterations.
  void note(int iteration, const SliceFigures& figures);
  /// A pass has ended with the figures it noted last.
  void end(const Outcome& outcome);
  /// A job that no slice asked for needs.
  void skip();
  void add_dark(std::int64_t voxels) { dark_part_voxels_ += voxels; }
  /// A slice as it leaves the optimiser, and how often it occurs.
  void add(const model::DoseStatistics& statistics, const model::DoseMetrics& figures, int times);
  /// Its voxels that the surface cuts.
  void add_cut(const model::DoseStatistics& statistics, int times) { cut_.merge(statistics, times); }
  /// What a slice leaves outside the part's box.
  void add_outside(const model::Outside& slice) { outside_.merge(slice); }
  void exchange(Archive& archive);
  /// Fills in what all passes together say of the dose. job_of_slice: as in Schedule.
  void complete(VolumeOutcome& outcome, bool grey, std::span<const int> job_of_slice) const;

 private:
  std::vector<SliceFigures> rows_, ends_;  // per iteration: of passes that got there, of passes that ended there
  SliceFigures last_;
  int seen_ = -1;
  model::DoseStatistics total_, cut_;
  model::Outside outside_;
  SliceFigures figures_;
  std::vector<double> min_part_, max_void_;  // of each job; -1: none
  StopReason stop_ = StopReason::iterations;
  int iterations_ = 0;
  std::int64_t dark_part_voxels_ = 0;
};

}  // namespace vam::optimize
