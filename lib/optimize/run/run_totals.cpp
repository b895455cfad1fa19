// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/run_totals.hpp"

#include "base/index.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/private/misses.hpp"

namespace vam::optimize {

void RunTotals::note(int iteration, const SliceFigures& figures) {
  const auto i = static_cast<std::size_t>(iteration);
  if (rows_.size() <= i) {
    rows_.resize(i + 1);
    ends_.resize(i + 1);
  }
  rows_[i].add(figures);
  last_ = figures;
  seen_ = iteration;
}

void RunTotals::end(const Outcome& outcome) {
  if (seen_ >= 0) ends_[seen_].add(last_);
  seen_ = -1;
  if (outcome.iterations < iterations_) return;
  iterations_ = outcome.iterations;
  stop_ = outcome.stop;
  growth_ = outcome.growth;
}

void RunTotals::add(std::span<const Slab> dose, const Problem& problem, const Pass& pass, const Jobs& jobs,
                    const model::VoxelBox& part) {
  const bool grey = problem.demands.grey;
  const auto whole = whole_statistics(dose, problem);
  const auto cut = cut_statistics(dose, problem);
  const auto of_grey = grey ? metrics(dose, problem) : std::vector<model::DoseMetrics>{};
  min_part_.resize(pass.last, -1);
  max_void_.resize(pass.last, -1);
  for (int job = pass.first; job < pass.last; ++job) {
    const int i = job - pass.low;
    const int times = jobs.multiplicity[job];
    if (times == 0) continue;
    const model::DoseMetrics figures = grey ? of_grey[i] : whole[i].metrics();
    total_.merge(whole[i], times);
    cut_.merge(cut[i], times);
    figures_.add(figures, times);
    if (figures.part > 0) min_part_[job] = figures.min_part;
    if (figures.void_ > 0) max_void_[job] = figures.max_void;
  }
  if (!grey) add_outside(dose, problem, pass, jobs, part);
}

/// Identical slices share a job, but some may be level with the part and others above or below it.
void RunTotals::add_outside(std::span<const Slab> dose, const Problem& problem, const Pass& pass, const Jobs& jobs,
                            const model::VoxelBox& part) {
  const StraySlices found = outside_part(dose, problem, part);
  for (int k = jobs.selection.from; k < jobs.selection.to; ++k) {
    const int job = jobs.schedule.job_of_slice[k];
    if (job < pass.first || job >= pass.last) continue;
    const bool beside = k >= part.low[2] && k <= part.high[2];
    outside_.merge((beside ? found.beside : found.whole)[job - pass.low]);
  }
}

void RunTotals::exchange(Archive& archive) {
  const auto each = [&](SliceFigures& figures) { figures.exchange(archive); };
  archive.list(rows_, each);
  archive.list(ends_, each);
  last_.exchange(archive);
  archive(seen_);
  total_.exchange(archive);
  cut_.exchange(archive);
  archive(outside_.voxels);
  archive(outside_.gelled_voxels);
  archive(outside_.max_dose);
  figures_.exchange(archive);
  archive(min_part_);
  archive(max_void_);
  archive(stop_);
  archive(growth_);
  archive(iterations_);
  archive(dark_part_voxels_);
}

void RunTotals::complete(VolumeOutcome& outcome, bool grey, std::span<const int> job_of_slice) const {
  SliceFigures ended;  // passes that stopped earlier count with their last state
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    SliceFigures all = rows_[i];
    all.add(ended);
    outcome.trace.push_back(all.mean());
    ended.add(ends_[i]);
  }
  model::DoseStatistics with_cut;
  with_cut.merge(total_);
  with_cut.merge(cut_);
  outcome.metrics = grey ? figures_.mean() : total_.metrics();
  outcome.all_cut = !grey && outcome.metrics.part == 0;
  if (outcome.all_cut) outcome.metrics = with_cut.metrics();
  if (!grey) outcome.with_cut = with_cut.metrics();
  if (!grey) outcome.outside = outside_;
  const auto of = [](const std::vector<double>& doses, int job) { return job < count_of(doses) ? doses[job] : -1; };
  for (const int job : job_of_slice) {
    if (!grey) outcome.demands.push_back({.min_part = of(min_part_, job), .max_void = of(max_void_, job)});
  }
  outcome.iterations = iterations_;
  outcome.stop = stop_;
  outcome.growth = growth_;
  outcome.dark_part_voxels = dark_part_voxels_;
}

}  // namespace vam::optimize
