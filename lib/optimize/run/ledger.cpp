// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/ledger.hpp"

namespace vam::optimize {

void Ledger::note(int iteration, const SliceFigures& figures) {
  const auto i = static_cast<std::size_t>(iteration);
  if (rows_.size() <= i) {
    rows_.resize(i + 1);
    ends_.resize(i + 1);
  }
  rows_[i].add(figures);
  last_ = figures;
  seen_ = iteration;
}

void Ledger::end(const Outcome& outcome) {
  if (seen_ >= 0) ends_[seen_].add(last_);
  seen_ = -1;
  if (outcome.iterations < iterations_) return;
  iterations_ = outcome.iterations;
  stop_ = outcome.stop;
}

void Ledger::add(const model::DoseStatistics& statistics, const model::DoseMetrics& figures, int times) {
  if (times == 0) return skip();
  total_.merge(statistics, times);
  figures_.add(figures, times);
  min_part_.push_back(figures.part > 0 ? figures.min_part : -1);
  max_void_.push_back(figures.void_ > 0 ? figures.max_void : -1);
}

void Ledger::skip() {
  min_part_.push_back(-1);
  max_void_.push_back(-1);
}

void Ledger::exchange(Archive& archive) {
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
  archive(iterations_);
  archive(dark_part_voxels_);
}

void Ledger::complete(VolumeOutcome& outcome, bool grey, std::span<const int> job_of_slice) const {
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
  for (const int job : job_of_slice) {
    if (!grey) outcome.asked.push_back({.min_part = min_part_[job], .max_void = max_void_[job]});
  }
  outcome.iterations = iterations_;
  outcome.stop = stop_;
  outcome.dark_part_voxels = dark_part_voxels_;
}

}  // namespace vam::optimize
